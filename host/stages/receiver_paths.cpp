// SPDX-License-Identifier: Apache-2.0
#include "host/stages/receiver_paths.h"

#include "host/base/receiver_bundles.h"
#include "host/stages/joint_programs.h"
#include "kernels/shared/receiver_paths.h"

namespace nearlight::core {
namespace {

/// How many receivers of a bundle a work-item of receiver_spacing has. Each reads the whole bundle, but GPUs
/// need many work-items.
uint spacing_part(const Device& device) {
    return device.is_cpu() ? kBundleReceivers : 8;
}

uint shared_kinds(const ReceiverPathSettings& settings) {
    return NEARLIGHT_SHARES_NEAR | (settings.shares_sky ? NEARLIGHT_SHARES_SKY : 0u) |
           (settings.shares_veiled ? NEARLIGHT_SHARES_VEILED : 0u) |
           (settings.shares_reflections ? NEARLIGHT_SHARES_REFLECTIONS : 0u);
}

ReceiverPathParams params_of(const ReceiverBatch& batch, uint kinds) {
    const ReceiverPathSettings& settings = batch.settings;
    return {.packet_count = static_cast<uint>(batch.packet_count),
            .light_samples = settings.light_samples,
            .rays = settings.rays,
            .max_edges = settings.max_edges,
            .clamp_radius = settings.clamp_radius,
            .seed = settings.seed,
            .shares = kinds,
            .aimed_rays = settings.rays > 0 ? settings.aimed_rays : 0,
            .shared_limit = settings.shared_limit};
}

}  // namespace

FoundLights::FoundLights(Device& device, std::size_t packet_count, const ReceiverPathSettings& settings)
    : near(device, packet_count * NEARLIGHT_PACKET_SIZE),
      sky(device, settings.shares_sky ? near.count() : 0),
      veiled(device, settings.shares_veiled ? near.count() : 0),
      reflected(device, settings.shares_reflections ? near.count() : 0),
      reflections(device, reflected.count()),
      spacing(device, reflected.count()) {}

ReceiverPaths::ReceiverPaths(Device& device)
    : program_(device, "receiver_paths.cl", kViewProgram),
      receiver_paths_(program_, "receiver_paths"),
      receiver_spacing_(program_, "receiver_spacing"),
      caustic_errors_(program_, "caustic_errors"),
      none_found_(device, 0, {}) {}

void ReceiverPaths::run(const ReceiverBatch& batch, Buffer<IrradiancePacket>& direct,
                        Buffer<IrradiancePacket>& indirect) {
    launch(batch, 0u, direct, indirect, none_found_);
}

void ReceiverPaths::run_sharing(const ReceiverBatch& batch, Buffer<IrradiancePacket>& direct,
                                Buffer<IrradiancePacket>& indirect, FoundLights& found) {
    if (batch.settings.shares_reflections) {
        const auto packets = static_cast<uint>(batch.packet_count);
        const uint part = spacing_part(program_.device());
        receiver_spacing_.launch_items(BundleLayout{packets}.bundle_count() * (kBundleReceivers / part),
                                       batch.receivers, packets, batch.settings.max_edges, part,
                                       found.spacing);
    }
    launch(batch, shared_kinds(batch.settings), direct, indirect, found);
}

CausticErrors ReceiverPaths::caustic_errors(const ReceiverBatch& batch) {
    const std::size_t count = batch.packet_count * NEARLIGHT_PACKET_SIZE;
    Buffer<float> unaimed(program_.device(), count);
    Buffer<float> aimed(program_.device(), count);
    caustic_errors_.launch_items(count, batch.scene, batch.receivers, params_of(batch, 0u), unaimed, aimed,
                                 batch.scene.caustic_aims);
    return {unaimed.download(), aimed.download()};
}

void ReceiverPaths::launch(const ReceiverBatch& batch, uint kinds, Buffer<IrradiancePacket>& direct,
                           Buffer<IrradiancePacket>& indirect, FoundLights& found) {
    receiver_paths_.launch_items(batch.packet_count * NEARLIGHT_PACKET_SIZE, batch.scene,
                                 VeilsForRays{batch.scene}, batch.receivers, params_of(batch, kinds), direct,
                                 indirect, found.near, found.sky, found.veiled, found.reflected,
                                 found.reflections, found.spacing, batch.scene.caustic_aims);
}

}  // namespace nearlight::core
