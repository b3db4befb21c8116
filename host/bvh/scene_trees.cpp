// SPDX-License-Identifier: Apache-2.0
#include "host/bvh/scene_trees.h"

#include <utility>

namespace nearlight::core {
namespace {

ShapedBvh shaped(Bvh&& bvh, const TreeShapes& shapes) {
    ShapedBvh result;
    if (shapes.wide) {
        result.wide = widen(bvh);
    }
    if (shapes.binary) {
        result.binary = std::move(bvh);
    }
    return result;
}

}  // namespace

SceneTrees build_scene_trees(const Scene& scene, const BvhConfig& config, const TreeShapes& shapes) {
    SceneBvhs bvhs = build_scene_bvhs(scene, config);
    return {.opaque = shaped(std::move(bvhs.opaque), shapes),
            .glass = shaped(std::move(bvhs.glass), shapes),
            .has_glass = bvhs.has_glass};
}

}  // namespace nearlight::core
