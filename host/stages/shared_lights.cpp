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
void SharedLights::find_seeing_receivers(const DeviceScene& scene, const Buffer<ReceiverPacket>& receivers,
                                         std::size_t packet_count, const ReceiverPathSettings& settings,
                                         const Buffer<SharedLight>& found) {
    const std::size_t bundle_count = BundleLayout{static_cast<uint>(packet_count)}.bundle_count();
    const auto launch_on = [&](std::size_t items, std::size_t local_size, const auto& nodes,
                               const auto& triangles, const auto&... rest) {
        visibility_.launch(items, local_size, nodes, triangles, receivers, static_cast<uint>(packet_count),
                           found, settings.clamp_radius * settings.clamp_radius, settings.max_edges,
                           settings.path_count, listed_, lengths_, factors_, seen_by_, rest...);
    };
    if (kernel_ == GatherKernel::rays) {
        launch_on(bundle_count * NEARLIGHT_SHARED_LIST, device_->tunables().local_size, scene.tree.nodes,
                  scene.tree.triangles);
    } else {
        next_bundle_.fill_zero();
        launch_on(bundle_count, 1, scene.tree.wide_nodes, scene.tree.blocks, next_bundle_);
    }
}

void SharedLights::add(const DeviceScene& scene, const Buffer<ReceiverPacket>& receivers,
                       std::size_t packet_count, const ReceiverPathSettings& settings,
                       const Buffer<SharedLight>& found, Buffer<IrradiancePacket>& irradiance) {
    const auto packets = static_cast<uint>(packet_count);
    const std::size_t bundle_count = BundleLayout{packets}.bundle_count();
    make_lists(bundle_count);
    choose_.launch_items(bundle_count, receivers, packets, found, settings.seed, listed_, factors_, lengths_);
    find_seeing_receivers(scene, receivers, packet_count, settings, found);
    const Buffer<float>* curves = scene.curves_in_use();
    gather_.launch_items(packet_count * NEARLIGHT_PACKET_SIZE, receivers, packets, found,
                         curves != nullptr ? *curves : no_curves_,
                         settings.clamp_radius * settings.clamp_radius, listed_, factors_, lengths_, seen_by_,
                         irradiance);
}

}  // namespace nearlight::core
