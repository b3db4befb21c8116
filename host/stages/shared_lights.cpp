// SPDX-License-Identifier: Apache-2.0
#include "host/stages/shared_lights.h"

#include "host/stages/joint_programs.h"

namespace nearlight::core {

SharedLights::SharedLights(Device& device)
    : program_(device, "shared_lights.cl", kViewProgram),
      gather_(program_, "shared_light_gather"),
      no_curves_(device, 0) {}

void SharedLights::add(const ReceiverBatch& batch, SharedLightLists& lists, const Buffer<SharedLight>& found,
                       Buffer<IrradiancePacket>& irradiance) {
    const float radius = batch.settings.clamp_radius;
    lists.make(batch,
               {.shares = NEARLIGHT_SHARES_NEAR, .count = NEARLIGHT_SHARED_LIGHTS, .max_distance = radius},
               found);
    const Buffer<float>* curves = batch.scene.curves_in_use();
    gather_.launch_items(batch.packet_count * NEARLIGHT_PACKET_SIZE, batch.receivers,
                         static_cast<uint>(batch.packet_count), found,
                         curves != nullptr ? *curves : no_curves_, radius * radius, lists, irradiance);
}

}  // namespace nearlight::core
