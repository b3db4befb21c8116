// SPDX-License-Identifier: Apache-2.0
#include "host/stages/opaque_tree.h"

#include "host/bvh/wide_bvh.h"

namespace nearlight {

GatherKernel choose_kernel(GatherKernel kernel, const Device& device) {
    if (kernel == GatherKernel::automatic) {
        return device.is_cpu() ? GatherKernel::packets : GatherKernel::rays;
    }
    return kernel;
}

OpaqueTree upload_tree(Device& device, const Bvh& bvh, GatherKernel kernel) {
    OpaqueTree tree{
        .nodes = {device, bvh.nodes}, .triangles = {device, bvh.triangles}, .wide_nodes = {}, .blocks = {}};
    if (choose_kernel(kernel, device) == GatherKernel::packets) {
        const WideBvh wide = widen(bvh);
        tree.wide_nodes = {device, wide.nodes};
        tree.blocks = {device, wide.blocks};
    }
    return tree;
}

}  // namespace nearlight
