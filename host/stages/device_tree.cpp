// SPDX-License-Identifier: Apache-2.0
#include "host/stages/device_tree.h"

#include "host/base/names.h"

namespace nearlight::core {
namespace {

DeviceTree upload(Device& device, const Bvh* binary, const WideBvh* wide) {
    DeviceTree tree;
    tree.has_wide_rays = device.has_wide_rays();
    if (wide != nullptr) {
        tree.wide_nodes = {device, wide->nodes};
        tree.blocks = {device, wide->blocks};
    }
    if (binary != nullptr) {
        tree.nodes = {device, binary->nodes};
        tree.triangles = {device, binary->triangles};
    }
    tree.triangle_ids = {device, tree.has_wide_rays ? wide->triangle_ids : binary->triangle_ids};
    return tree;
}

DeviceTree upload(Device& device, const Bvh& bvh, const TreeShapes& shapes) {
    const WideBvh wide = shapes.wide ? widen(bvh) : WideBvh{};
    return upload(device, shapes.binary ? &bvh : nullptr, shapes.wide ? &wide : nullptr);
}

}  // namespace

const char* to_string(GatherKernel kernel) {
    return name_in(kGatherKernels, kernel);
}

GatherKernel choose_kernel(GatherKernel kernel, const Device& device) {
    if (kernel == GatherKernel::automatic) {
        return device.is_cpu() ? GatherKernel::packets : GatherKernel::rays;
    }
    return kernel;
}

TreeShapes ray_tree_shapes(const Device& device) {
    return {.binary = !device.has_wide_rays(), .wide = device.has_wide_rays()};
}

TreeShapes tree_shapes(const Device& device, GatherKernel kernel) {
    const TreeShapes rays = ray_tree_shapes(device);
    const bool packets = choose_kernel(kernel, device) == GatherKernel::packets;
    return {.binary = rays.binary || !packets, .wide = rays.wide || packets};
}

DeviceTree upload(Device& device, const ShapedBvh& tree, const TreeShapes& shapes) {
    return upload(device, shapes.binary ? &tree.binary : nullptr, shapes.wide ? &tree.wide : nullptr);
}

DeviceTree upload_ray_tree(Device& device, const Bvh& bvh) {
    return upload(device, bvh, ray_tree_shapes(device));
}

DeviceTree upload_tree(Device& device, const Bvh& bvh, GatherKernel kernel) {
    return upload(device, bvh, tree_shapes(device, kernel));
}

DeviceTree upload_both_trees(Device& device, const Bvh& bvh) {
    return upload(device, bvh, {.binary = true, .wide = true});
}

}  // namespace nearlight::core
