// SPDX-License-Identifier: Apache-2.0
#include "host/stages/shared_lights.h"

#include "host/stages/joint_programs.h"

namespace nearlight::core {

SharedLights::SharedLights(Device& device, GatherKernel kernel)
    : lists_(device, kernel),
      program_(device, "shared_lights.cl", kViewProgram),
      gather_(program_, "shared_light_gather"),
      no_curves_(device, 0) {}

void SharedLights::add(const DeviceScene& scene, const Buffer<ReceiverPacket>& receivers,
                       std::size_t packet_count, const ReceiverPathSettings& settings,
                       const Buffer<SharedLight>& found, Buffer<IrradiancePacket>& irradiance) {
    const float radius = settings.clamp_radius;
    lists_.make(scene, receivers, packet_count, settings, radius, found, NEARLIGHT_SHARED_LIGHTS);
    const Buffer<float>* curves = scene.curves_in_use();
    gather_.launch_items(packet_count * NEARLIGHT_PACKET_SIZE, receivers, static_cast<uint>(packet_count),
                         found, curves != nullptr ? *curves : no_curves_, radius * radius, lists_,
                         irradiance);
}

}  // namespace nearlight::core
