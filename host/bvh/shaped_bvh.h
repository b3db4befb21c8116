// SPDX-License-Identifier: Apache-2.0
// The tree of a scene in the shapes that kernels traverse.
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

/// Builds the tree of build_scene_bvh() in the given shapes.
ShapedBvh build_scene_tree(const Scene& scene, const BvhConfig& config, const TreeShapes& shapes);

}  // namespace nearlight::core
