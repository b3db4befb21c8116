// SPDX-License-Identifier: Apache-2.0
// A tree in device memory, in the shapes that kernels go through.
#pragma once

#include "host/bvh/scene_trees.h"
#include "host/cl/buffer.h"
#include "nearlight/settings.h"

namespace nearlight::core {

/// What `automatic` means on the device; the others are what they are.
GatherKernel choose_kernel(GatherKernel kernel, const Device& device);

/// Of each shape, buffers are empty where nobody asked for it.
struct DeviceTree {
    Buffer<BvhNode>
        nodes;  ///< binary: for `rays`, and for single rays where they do not go through the other
    Buffer<BvhTriangle> triangles;
    Buffer<WideNode> wide_nodes;   ///< the same tree widened: for `packets`, and for single rays on CPUs
    Buffer<TriangleBlock> blocks;  ///< of the wide tree
    Buffer<uint> triangle_ids;     ///< in Scene::triangles, of each slot that a single ray may hit
    bool has_wide_rays = false;    ///< single rays go through the wide tree (Device::has_wide_rays())

    [[nodiscard]] bool is_binary() const { return nodes.count() > 0; }
    [[nodiscard]] bool is_wide() const { return wide_nodes.count() > 0; }

    /// Nodes and triangles for single rays, as kernels/lib/ray_tree.cl takes them.
    template <typename Visitor>
    void for_each_buffer(Visitor&& visit) const {
        if (has_wide_rays) {
            visit(wide_nodes), visit(blocks);
        } else {
            visit(nodes), visit(triangles);
        }
    }
};

/// What a device wants of a tree for single rays, and for gathers with `kernel` too.
TreeShapes ray_tree_shapes(const Device& device);
TreeShapes tree_shapes(const Device& device, GatherKernel kernel);

/// In those shapes, which the tree must have.
DeviceTree upload(Device& device, const ShapedBvh& tree, const TreeShapes& shapes);

/// For single rays alone.
DeviceTree upload_ray_tree(Device& device, const Bvh& bvh);
/// For single rays and for gathers with `kernel`.
DeviceTree upload_tree(Device& device, const Bvh& bvh, GatherKernel kernel = GatherKernel::automatic);
/// For those and for gathers with either kernel.
DeviceTree upload_both_trees(Device& device, const Bvh& bvh);

}  // namespace nearlight::core
