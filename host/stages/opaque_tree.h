// SPDX-License-Identifier: Apache-2.0
// The tree of the opaque surfaces in device memory, in the shapes that kernels go through.
#pragma once

#include "host/bvh/bvh.h"
#include "host/cl/buffer.h"

namespace nearlight {

/// Which kernel gathers. Both compute the same sum; visibility may differ for rays that meet an edge of a
/// triangle within rounding.
enum class GatherKernel {
    automatic,  ///< packets on CPUs, rays elsewhere
    packets,    ///< gather_packets.cl: one work-item, up to 256 receivers in vector registers
    rays,       ///< gather_rays.cl: one work-item, one receiver
};

/// What `automatic` means on the device; the others are what they are.
GatherKernel choose_kernel(GatherKernel kernel, const Device& device);

struct OpaqueTree {
    Buffer<BvhNode> nodes;  ///< binary: for single rays
    Buffer<BvhTriangle> triangles;
    Buffer<WideNode> wide_nodes;   ///< the same tree widened: for packets; empty where there are none
    Buffer<TriangleBlock> blocks;  ///< of the wide tree

    [[nodiscard]] bool is_wide() const { return wide_nodes.count() > 0; }
};

/// For gathers with `kernel`: the tree is widened only where that is `packets`.
OpaqueTree upload_tree(Device& device, const Bvh& bvh, GatherKernel kernel = GatherKernel::automatic);

}  // namespace nearlight
