// SPDX-License-Identifier: Apache-2.0
#include "host/stages/shared_reflections.h"

#include "host/base/receiver_bundles.h"
#include "host/stages/bundle_light.h"

namespace nearlight::core {

SharedReflections::SharedReflections(Device& device)
    : program_(device, "shared_reflections.cl"), gather_(program_, "shared_reflection_gather") {}

void SharedReflections::add(const ReceiverBatch& batch, SharedLightLists& lists, const FoundLights& found,
                            Buffer<IrradiancePacket>& irradiance) {
    lists.make(batch, {.shares = NEARLIGHT_SHARES_REFLECTIONS, .count = NEARLIGHT_SHARED_REFLECTIONS},
               found.reflected);
    const auto packets = static_cast<uint>(batch.packet_count);
    gather_.launch_bundles(BundleLayout{packets}.bundle_count(), batch.scene, batch.receivers, packets,
                           found.reflected, found.reflections, found.spacing, lists, irradiance,
                           BundleLight{});
}

}  // namespace nearlight::core
