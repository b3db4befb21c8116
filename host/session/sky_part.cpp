// SPDX-License-Identifier: Apache-2.0
#include "host/session/sky_part.h"

#include <algorithm>

#include "host/base/receivers.h"

namespace nearlight::core {

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
    std::size_t present = 0;
    for (const ReceiverPacket& packet : view.receivers.download()) {
        present += present_count(packet);
    }
    return static_cast<float>(met) / static_cast<float>(std::max<std::size_t>(present, 1));
}

}  // namespace nearlight::core
