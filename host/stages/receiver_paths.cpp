// SPDX-License-Identifier: Apache-2.0
#include "host/stages/receiver_paths.h"

#include "host/stages/joint_programs.h"

namespace nearlight::core {

ReceiverPaths::ReceiverPaths(Device& device)
    : program_(device, "receiver_paths.cl", kViewProgram),
      receiver_paths_(program_, "receiver_paths"),
      none_found_(device, 0) {}

void ReceiverPaths::run(const DeviceScene& scene, const Buffer<ReceiverPacket>& receivers,
                        std::size_t packet_count, const ReceiverPathSettings& settings,
                        Buffer<IrradiancePacket>& direct, Buffer<IrradiancePacket>& indirect) {
    receiver_paths_.launch_items(packet_count * NEARLIGHT_PACKET_SIZE, scene, receivers,
                                 static_cast<uint>(packet_count), settings.light_samples, settings.path_count,
                                 settings.max_edges, settings.clamp_radius, settings.seed, 0u, direct,
                                 indirect, none_found_.near, none_found_.sky);
}

void ReceiverPaths::run_sharing(const DeviceScene& scene, const Buffer<ReceiverPacket>& receivers,
                                std::size_t packet_count, const ReceiverPathSettings& settings,
                                Buffer<IrradiancePacket>& direct, Buffer<IrradiancePacket>& indirect,
                                FoundLights& found) {
    receiver_paths_.launch_items(packet_count * NEARLIGHT_PACKET_SIZE, scene, receivers,
                                 static_cast<uint>(packet_count), settings.light_samples, settings.path_count,
                                 settings.max_edges, settings.clamp_radius, settings.seed,
                                 settings.shares_sky ? 2u : 1u, direct, indirect, found.near, found.sky);
}

}  // namespace nearlight::core
