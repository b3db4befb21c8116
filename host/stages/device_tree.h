// SPDX-License-Identifier: Apache-2.0
// A tree in device memory, in the shapes that kernels traverse.
#pragma once

#include <array>
#include <utility>

#include "host/bvh/shaped_bvh.h"
#include "host/cl/buffer.h"
#include "nearlight/settings.h"

namespace nearlight::core {

/// The names of all gather kernels.
inline constexpr std::array kGatherKernels{std::pair{"auto", GatherKernel::automatic},
                                           std::pair{"packets", GatherKernel::packets},
                                           std::pair{"rays", GatherKernel::rays}};

const char* to_string(GatherKernel kernel);

/// Replaces `automatic` by the kernel that suits the device, and returns any other kernel unchanged.
GatherKernel choose_kernel(GatherKernel kernel, const Device& device);

/// A tree in device memory. The buffers of a shape that was not asked for are empty.
struct DeviceTree {
    Buffer<BvhNode> nodes;  ///< binary tree: for `rays`, and for single rays unless they use the wide tree
    Buffer<BvhTriangle> triangles;
    Buffer<WideNode> wide_nodes;   ///< wide tree: for `packets`, and for single rays on CPUs
    Buffer<TriangleBlock> blocks;  ///< triangles of the wide tree
    Buffer<uint> triangle_ids;     ///< index in Scene::triangles for each slot that a single ray may hit
    bool has_wide_rays = false;    ///< single rays use the wide tree (Device::has_wide_rays())

    [[nodiscard]] bool is_wide() const { return wide_nodes.count() > 0; }

    /// Calls visit(buffer) for the nodes and triangles for single rays, in the order that
    /// kernels/lib/ray_tree.cl takes them.
    template <typename Visitor>
    void for_each_buffer(Visitor&& visit) const {
        if (has_wide_rays) {
            visit(wide_nodes), visit(blocks);
        } else {
            visit(nodes), visit(triangles);
        }
    }
};

/// The shapes of a tree that a device needs for single rays.
TreeShapes ray_tree_shapes(const Device& device);
/// The shapes of a tree that a device needs for single rays and for gathers with `kernel`.
TreeShapes tree_shapes(const Device& device, GatherKernel kernel);

/// Uploads the given shapes of a tree, which must have them.
DeviceTree upload(Device& device, const ShapedBvh& tree, const TreeShapes& shapes);

/// Uploads a tree for single rays alone.
DeviceTree upload_ray_tree(Device& device, const Bvh& bvh);
/// Uploads a tree for single rays and for gathers with `kernel`.
DeviceTree upload_tree(Device& device, const Bvh& bvh, GatherKernel kernel = GatherKernel::automatic);
/// Uploads a tree for single rays and for gathers with either kernel.
DeviceTree upload_both_trees(Device& device, const Bvh& bvh);

}  // namespace nearlight::core
