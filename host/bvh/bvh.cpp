// SPDX-License-Identifier: Apache-2.0
#include "host/bvh/bvh.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "host/bvh/child_order.h"
#include "host/bvh/flatten.h"
#include "host/bvh/reinsertion.h"
#include "host/bvh/sah_builder.h"

namespace nearlight::core {

const char* to_string(BvhQuality quality) {
    return quality == BvhQuality::quality ? "quality" : "fast";
}

Bvh build_bvh(const Scene& scene, std::span<const uint> ids, const BvhConfig& config) {
    if (ids.empty()) {
        return empty_bvh();
    }
    SahTree tree = build_sah_tree(scene, ids, config);
    if (config.quality != BvhQuality::quality) {
        return flatten(std::move(tree), scene, config);
    }
    reinsert_largest(tree);
    Bvh bvh = flatten(std::move(tree), scene, config);
    order_children(bvh, scene, ids);
    return bvh;
}

std::vector<uint> distinct_triangles(const Bvh& bvh) {
    std::vector<uint> ids = bvh.triangle_ids;
    std::sort(ids.begin(), ids.end());
    ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
    return ids;
}

Bvh build_scene_bvh(const Scene& scene, const BvhConfig& config) {
    std::vector<uint> ids(scene.triangles.size());
    std::iota(ids.begin(), ids.end(), 0u);
    return build_bvh(scene, ids, config);
}

}  // namespace nearlight::core
