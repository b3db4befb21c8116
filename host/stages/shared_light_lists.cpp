// SPDX-License-Identifier: Apache-2.0
#include "host/stages/shared_light_lists.h"

#include "host/base/receiver_bundles.h"
#include "host/stages/joint_programs.h"

namespace nearlight::core {
namespace {

constexpr uint kRandomPurpose = 0x5a4e0u;
constexpr std::size_t kMaskWords = kBundleReceivers / 32;

Kernel visibility_kernel(Device& device, GatherKernel kernel) {
    if (kernel == GatherKernel::rays) {
        return {Program(device, "shared_light_rays.cl"), "shared_light_rays"};
    }
    const Defines defines{{"GATHER_BEAM_WIDTH", std::to_string(device.tunables().beam_width)}};
    return {Program(device, "shared_light_packets.cl", defines), "shared_light_packets"};
}

}  // namespace

SharedLightLists::SharedLightLists(Device& device, GatherKernel kernel)
    : device_(&device),
      kernel_(choose_kernel(kernel, device)),
      program_(device, "shared_lights.cl", kViewProgram),
      choose_(program_, "shared_light_choose"),
      visibility_(visibility_kernel(device, kernel_)),
      next_bundle_(device, 1) {}

void SharedLightLists::make_room(std::size_t bundle_count) {
    const std::size_t entries = bundle_count * NEARLIGHT_SHARED_LIST;
    ensure_room(listed_, *device_, entries);
    ensure_room(factors_, *device_, entries);
    ensure_room(lengths_, *device_, bundle_count);
    ensure_room(seen_by_, *device_, entries * kMaskWords);
}

void SharedLightLists::make(const ReceiverBatch& batch, const SharedLightKind& kind,
                            const Buffer<SharedLight>& found) {
    const DeviceScene& scene = batch.scene;
    const ReceiverPathSettings& settings = batch.settings;
    const auto packets = static_cast<uint>(batch.packet_count);
    const std::size_t bundle_count = BundleLayout{packets}.bundle_count();
    make_room(bundle_count);
    choose_.launch_items(bundle_count, batch.receivers, packets, found, kind.count, settings.seed,
                         kRandomPurpose + kind.shares, listed_, factors_, lengths_);
    const auto launch_on = [&](std::size_t items, std::size_t local_size, const auto& nodes,
                               const auto& triangles, const auto&... rest) {
        visibility_.launch(items, local_size, nodes, triangles, batch.receivers, packets, found,
                           kind.max_distance * kind.max_distance, settings.max_edges, settings.rays, listed_,
                           lengths_, factors_, seen_by_, rest...);
    };
    if (kernel_ == GatherKernel::rays) {
        launch_on(bundle_count * NEARLIGHT_SHARED_LIST, device_->tunables().local_size, scene.tree.nodes,
                  kind.hiding == Hiding::solids ? scene.solid_triangles() : scene.tree.triangles);
    } else {
        next_bundle_.fill_zero();
        launch_on(bundle_count, 1, scene.tree.wide_nodes,
                  kind.hiding == Hiding::solids ? scene.solid_blocks() : scene.tree.blocks, next_bundle_);
    }
}

}  // namespace nearlight::core
