// SPDX-License-Identifier: Apache-2.0
#include "host/session/sky_part.h"

#include <algorithm>

#include "host/base/receivers.h"

namespace nearlight::core {
namespace {

/// How many receivers of the packet keep what their rays find of the sky. Those whose normal a map tilts do
/// not (kernels/lib/shared_light.cl).
std::size_t looking_count(const ReceiverPacket& packet) {
    std::size_t count = 0;
    for (std::size_t lane = 0; lane < NEARLIGHT_PACKET_SIZE; ++lane) {
        count += is_zero(receiver_at(packet, lane).normal) || packet.mesh_normal[lane] != 0 ? 0 : 1;
    }
    return count;
}

}  // namespace

float sky_part(Device& device, ReceiverPaths& paths, const DeviceScene& scene, const PilotView& view,
               uint seed) {
    if (!scene.has_sky() || view.packet_count == 0) {
        return 0.0f;
    }
    Buffer<IrradiancePacket> direct(device, view.packet_count);
    Buffer<IrradiancePacket> indirect(device, view.packet_count);
    // So many edges that receivers behind glass take part, and a radius so small that no near light does.
    const ReceiverPathSettings settings{
        .rays = 1, .max_edges = 64, .clamp_radius = 1e-6f, .seed = seed, .shares_sky = true};
    FoundLights found(device, view.packet_count, settings);
    paths.run_sharing({scene, view.receivers, view.packet_count, settings}, direct, indirect, found);
    const std::vector<SharedLight> lights = found.sky.download();
    const auto met = std::ranges::count_if(lights, [](const SharedLight& light) { return light.weight > 0; });
    std::size_t looking = 0;
    for (const ReceiverPacket& packet : view.receivers.download()) {
        looking += looking_count(packet);
    }
    return static_cast<float>(met) / static_cast<float>(std::max<std::size_t>(looking, 1));
}

}  // namespace nearlight::core
