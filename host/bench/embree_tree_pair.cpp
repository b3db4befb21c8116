// SPDX-License-Identifier: Apache-2.0
#include "host/bench/embree_tree_pair.h"

namespace nearlight::core {

EmbreeTreePair::EmbreeTreePair(const Scene& scene, std::span<const uint> ids)
    : device_(open_embree(report_)) {
    const auto build = [&](RTCBuildQuality quality) {
        return build_embree_tree(device_.get(), report_, scene, ids, quality, RTC_SCENE_FLAG_NONE);
    };
    medium_ = build(RTC_BUILD_QUALITY_MEDIUM);
    high_ = build(RTC_BUILD_QUALITY_HIGH);
}

}  // namespace nearlight::core
