// SPDX-License-Identifier: Apache-2.0
#include "host/stages/shared_lights.h"

#include "host/base/receiver_bundles.h"
#include "host/stages/joint_programs.h"

namespace nearlight::core {
namespace {

constexpr std::size_t kMaskWords = std::size_t{NEARLIGHT_BUNDLE_PACKETS} * NEARLIGHT_PACKET_SIZE / 32;

Kernel visibility_kernel(Device& device, GatherKernel kernel) {
    if (kernel == GatherKernel::rays) {
        return {Program(device, "shared_light_rays.cl"), "shared_light_rays"};
    }
    const Defines defines{{"GATHER_BEAM_WIDTH", std::to_string(device.tunables().beam_width)}};
    return {Program(device, "shared_light_packets.cl", defines), "shared_light_packets"};
}

}  // namespace

SharedLights::SharedLights(Device& device, GatherKernel kernel)
    : device_(&device),
      kernel_(choose_kernel(kernel, device)),
      program_(device, "shared_lights.cl", kViewProgram),
      choose_(program_, "shared_light_choose"),
      gather_(program_, "shared_light_gather"),
      visibility_(visibility_kernel(device, kernel_)),
      next_bundle_(device, 1),
      no_curves_(device, 0) {}

void SharedLights::make_lists(std::size_t bundle_count) {
    if (lengths_.count() < bundle_count) {
        const std::size_t entries = bundle_count * NEARLIGHT_SHARED_LIST;
        listed_ = Buffer<uint>(*device_, entries);
        factors_ = Buffer<float>(*device_, entries);
        lengths_ = Buffer<uint>(*device_, bundle_count);
        seen_by_ = Buffer<uint>(*device_, entries * kMaskWords);
    }
}

/// Finds for each listed light the receivers that see it, and the density of rays there.
void SharedLights::find_seeing_receivers(const SharedLightTask& task, std::size_t bundle_count) {
    const auto launch_on = [&](std::size_t items, std::size_t local_size, const auto& nodes,
                               const auto& triangles, const auto&... rest) {
        visibility_.launch(items, local_size, nodes, triangles, task.receivers,
                           static_cast<uint>(task.packet_count), task.found,
                           task.clamp_radius * task.clamp_radius, task.max_edges, task.rays_per_receiver,
                           listed_, lengths_, factors_, seen_by_, rest...);
    };
    const DeviceTree& tree = task.scene.tree;
    if (kernel_ == GatherKernel::rays) {
        launch_on(bundle_count * NEARLIGHT_SHARED_LIST, device_->tunables().local_size, tree.nodes,
                  tree.triangles);
    } else {
        next_bundle_.fill_zero();
        launch_on(bundle_count, 1, tree.wide_nodes, tree.blocks, next_bundle_);
    }
}

void SharedLights::add(const SharedLightTask& task, Buffer<IrradiancePacket>& irradiance) {
    const auto packet_count = static_cast<uint>(task.packet_count);
    const std::size_t bundle_count = BundleLayout{packet_count}.bundle_count();
    make_lists(bundle_count);
    choose_.launch_items(bundle_count, task.receivers, packet_count, task.found, task.seed, listed_, factors_,
                         lengths_);
    find_seeing_receivers(task, bundle_count);
    const Buffer<float>* curves = task.scene.curves_in_use();
    gather_.launch_items(task.packet_count * NEARLIGHT_PACKET_SIZE, task.receivers, packet_count, task.found,
                         curves != nullptr ? *curves : no_curves_, task.clamp_radius * task.clamp_radius,
                         listed_, factors_, lengths_, seen_by_, irradiance);
}

}  // namespace nearlight::core
