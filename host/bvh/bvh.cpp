// SPDX-License-Identifier: Apache-2.0
#include "host/bvh/bvh.h"

#include <algorithm>
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

SceneBvhs build_scene_bvhs(const Scene& scene, const BvhConfig& config) {
    std::vector<uint> opaque;
    std::vector<uint> glass;
    opaque.reserve(scene.triangles.size());
    for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
        const Material& material = scene.materials[scene.triangles[i].material];
        (is_glass(material) ? glass : opaque).push_back(static_cast<uint>(i));
    }
    return {build_bvh(scene, opaque, config), build_bvh(scene, glass, config), !glass.empty()};
}

}  // namespace nearlight::core
