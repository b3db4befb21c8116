// SPDX-License-Identifier: Apache-2.0
#include "host/stages/shared_veiled.h"

#include <limits>

#include "host/base/receiver_bundles.h"
#include "host/stages/joint_programs.h"

namespace nearlight::core {

SharedVeiled::SharedVeiled(Device& device, GatherKernel kernel)
    : lists_(device, kernel),
      program_(device, "shared_veiled.cl", kViewProgram),
      gather_(program_, "shared_veiled_gather") {}

void SharedVeiled::add(const DeviceScene& scene, const Buffer<ReceiverPacket>& receivers,
                       std::size_t packet_count, const ReceiverPathSettings& settings,
                       const Buffer<SharedLight>& found, Buffer<IrradiancePacket>& irradiance) {
    lists_.make(scene, receivers, packet_count, settings, std::numeric_limits<float>::infinity(), found,
                NEARLIGHT_SHARED_VEILED_LIGHTS, Hiding::solids);
    const auto packets = static_cast<uint>(packet_count);
    gather_.launch_items(BundleLayout{packets}.bundle_count(), scene, VeilsForRays{scene}, receivers, packets,
                         found, lists_, irradiance);
}

}  // namespace nearlight::core
