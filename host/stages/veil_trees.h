// SPDX-License-Identifier: Apache-2.0
// A scene's veils (kernels/lib/light/shadow.cl) and its other surfaces apart: bundles that share the sky or
// light of places behind veils first ask which receivers such a light reaches if nothing but veils is in the
// way, and then what the veils let through.
#pragma once

#include "host/scene/scene.h"
#include "host/stages/device_tree.h"

namespace nearlight::core {

struct VeilTrees {
    // The triangles of the scene's tree in the same slots. Where a veil was, there is a triangle that no ray
    // meets. The buffer of a shape that the scene's tree has not got is empty.
    Buffer<BvhTriangle> solid_triangles;
    Buffer<TriangleBlock> solid_blocks;
    DeviceTree veils;  ///< the veils alone, for single rays
};

/// Takes the scene's tree apart, in the shapes that are on the device.
VeilTrees make_veil_trees(Device& device, const Scene& scene, const ShapedBvh& tree,
                          const TreeShapes& shapes);

}  // namespace nearlight::core
