// SPDX-License-Identifier: Apache-2.0
#include "host/stages/direct_light.h"

#include "host/stages/joint_programs.h"

namespace nearlight::core {

DirectLight::DirectLight(Device& device)
    : program_(device, "direct_light.cl", kViewProgram), direct_light_(program_, "direct_light") {}

void DirectLight::run(const DeviceScene& scene, const Buffer<ReceiverPacket>& receivers,
                      std::size_t packet_count, uint sample_count, uint seed,
                      Buffer<IrradiancePacket>& irradiance) {
    direct_light_.launch_items(packet_count * NEARLIGHT_PACKET_SIZE, scene, receivers,
                               static_cast<uint>(packet_count), sample_count, seed, irradiance);
}

}  // namespace nearlight::core
