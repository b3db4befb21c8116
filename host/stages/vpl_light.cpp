// SPDX-License-Identifier: Apache-2.0
#include "host/stages/vpl_light.h"

#include "host/stages/joint_programs.h"

namespace nearlight::core {

VplLight::VplLight(Device& device)
    : program_(device, "vpl_light.cl", kVplsProgram),
      vpl_receivers_(program_, "vpl_receivers"),
      vpl_light_(program_, "vpl_light"),
      add_irradiance_(program_, "add_irradiance") {}

void VplLight::make_receivers(const Buffer<Vpl>& vpls, std::size_t vpl_count, VplSide side,
                              Buffer<ReceiverPacket>& receivers) {
    const std::size_t lane_count = receiver_packet_count(vpl_count) * NEARLIGHT_PACKET_SIZE;
    vpl_receivers_.launch_items(lane_count, vpls, static_cast<uint>(vpl_count), static_cast<uint>(lane_count),
                                side == VplSide::emits ? 1u : 0u, receivers);
}

void VplLight::apply(const Buffer<IrradiancePacket>& irradiance, std::size_t vpl_count, Buffer<Vpl>& vpls) {
    vpl_light_.launch_items(vpl_count, vpls, static_cast<uint>(vpl_count), irradiance);
}

void VplLight::add(const Buffer<IrradiancePacket>& more, std::size_t packet_count,
                   Buffer<IrradiancePacket>& irradiance) {
    const std::size_t lane_count = packet_count * NEARLIGHT_PACKET_SIZE;
    add_irradiance_.launch_items(lane_count, more, static_cast<uint>(lane_count), irradiance);
}

}  // namespace nearlight::core
