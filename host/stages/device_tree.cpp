// SPDX-License-Identifier: Apache-2.0
#include "host/stages/device_tree.h"

#include "host/bvh/wide_bvh.h"

namespace nearlight {
namespace {

DeviceTree upload(Device& device, const Bvh& bvh, bool binary, bool wide) {
    DeviceTree tree;
    tree.has_wide_rays = device.has_wide_rays();
    if (wide) {
        const WideBvh widened = widen(bvh);
        tree.wide_nodes = {device, widened.nodes};
        tree.blocks = {device, widened.blocks};
        if (tree.has_wide_rays) {
            tree.triangle_ids = {device, widened.triangle_ids};
        }
    }
    if (binary) {
        tree.nodes = {device, bvh.nodes};
        tree.triangles = {device, bvh.triangles};
    }
    if (!tree.has_wide_rays) {
        tree.triangle_ids = {device, bvh.triangle_ids};
    }
    return tree;
}

}  // namespace

GatherKernel choose_kernel(GatherKernel kernel, const Device& device) {
    if (kernel == GatherKernel::automatic) {
        return device.is_cpu() ? GatherKernel::packets : GatherKernel::rays;
    }
    return kernel;
}

DeviceTree upload_ray_tree(Device& device, const Bvh& bvh) {
    return upload(device, bvh, !device.has_wide_rays(), device.has_wide_rays());
}

DeviceTree upload_tree(Device& device, const Bvh& bvh, GatherKernel kernel) {
    const bool packets = choose_kernel(kernel, device) == GatherKernel::packets;
    return upload(device, bvh, !device.has_wide_rays() || !packets, device.has_wide_rays() || packets);
}

DeviceTree upload_both_trees(Device& device, const Bvh& bvh) {
    return upload(device, bvh, true, true);
}

}  // namespace nearlight
