// SPDX-License-Identifier: Apache-2.0
// The trees of a scene in the shapes that kernels go through.
#pragma once

#include "host/bvh/bvh.h"
#include "host/bvh/wide_bvh.h"

namespace nearlight::core {

/// Which are wanted.
struct TreeShapes {
    bool binary = false;  ///< for rays of a work-item each, as GPUs trace them
    bool wide = false;    ///< for CPUs
};

/// A tree in one shape or both; the other is empty.
struct ShapedBvh {
    Bvh binary;
    WideBvh wide;
};

/// What light and camera see, and the glass that only the camera sees.
struct SceneTrees {
    ShapedBvh opaque;
    ShapedBvh glass;
    bool has_glass = false;
};

/// build_scene_bvhs() in those shapes.
SceneTrees build_scene_trees(const Scene& scene, const BvhConfig& config, const TreeShapes& shapes);

}  // namespace nearlight::core
