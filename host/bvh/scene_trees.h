// SPDX-License-Identifier: Apache-2.0
// The trees of a scene in the shapes that kernels traverse.
#pragma once

#include "host/bvh/bvh.h"
#include "host/bvh/wide_bvh.h"

namespace nearlight::core {

/// The shapes that are wanted.
struct TreeShapes {
    bool binary = false;  ///< two children a node, for GPUs
    bool wide = false;    ///< eight children a node, for CPUs
};

/// A tree in one shape or both; a shape that is not wanted is empty.
struct ShapedBvh {
    Bvh binary;
    WideBvh wide;
};

/// The tree of what light and camera see, and that of the glass that only the camera sees.
struct SceneTrees {
    ShapedBvh opaque;
    ShapedBvh glass;
    bool has_glass = false;
};

/// Builds the trees of build_scene_bvhs() in the given shapes.
SceneTrees build_scene_trees(const Scene& scene, const BvhConfig& config, const TreeShapes& shapes);

}  // namespace nearlight::core
