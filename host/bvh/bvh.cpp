// SPDX-License-Identifier: Apache-2.0
#include "host/bvh/bvh.h"

#include "host/bvh/flatten.h"
#include "host/bvh/sah_builder.h"

namespace nearlight {

Bvh build_bvh(const Scene& scene, std::span<const uint> ids, const BvhConfig& config) {
    if (ids.empty()) {
        return empty_bvh();
    }
    return flatten(build_sah_tree(scene, ids, config), scene, config);
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

}  // namespace nearlight
