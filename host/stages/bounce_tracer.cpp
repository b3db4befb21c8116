// SPDX-License-Identifier: Apache-2.0
#include "host/stages/bounce_tracer.h"

#include "host/stages/joint_programs.h"

namespace nearlight::core {

BounceTracer::BounceTracer(Device& device)
    : program_(device, "bounce_tracer.cl", kWalksProgram), bounce_tracer_(program_, "bounce_tracer") {}

void BounceTracer::run(const DeviceScene& scene, const Buffer<ReceiverPacket>& receivers,
                       std::size_t packet_count, const BouncePaths& paths,
                       Buffer<IrradiancePacket>& irradiance) {
    if (paths.sample_count == 0 || paths.bounce_count == 0 || !(paths.clamp_radius > 0.0f)) {
        return;
    }
    bounce_tracer_.launch_items(packet_count * NEARLIGHT_PACKET_SIZE, scene, receivers,
                                static_cast<uint>(packet_count), paths.sample_count, paths.bounce_count,
                                paths.clamp_radius, paths.seed, irradiance);
}

}  // namespace nearlight::core
