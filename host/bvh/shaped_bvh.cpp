// SPDX-License-Identifier: Apache-2.0
#include "host/bvh/shaped_bvh.h"

#include <utility>

namespace nearlight::core {

ShapedBvh build_scene_tree(const Scene& scene, const BvhConfig& config, const TreeShapes& shapes) {
    Bvh bvh = build_scene_bvh(scene, config);
    ShapedBvh result;
    if (shapes.wide) {
        result.wide = widen(bvh);
    }
    if (shapes.binary) {
        result.binary = std::move(bvh);
    }
    return result;
}

}  // namespace nearlight::core
