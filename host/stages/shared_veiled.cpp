// SPDX-License-Identifier: Apache-2.0
#include "host/stages/shared_veiled.h"

#include "host/base/receiver_bundles.h"
#include "host/stages/bundle_light.h"

namespace nearlight::core {

SharedVeiled::SharedVeiled(Device& device)
    : program_(device, "shared_veiled.cl"), gather_(program_, "shared_veiled_gather") {}

void SharedVeiled::add(const ReceiverBatch& batch, SharedLightLists& lists, const Buffer<SharedLight>& found,
                       Buffer<IrradiancePacket>& irradiance) {
    lists.make(batch,
               {.shares = NEARLIGHT_SHARES_VEILED,
                .count = NEARLIGHT_SHARED_VEILED_LIGHTS,
                .hiding = Hiding::solids},
               found);
    const auto packets = static_cast<uint>(batch.packet_count);
    gather_.launch_bundles(BundleLayout{packets}.bundle_count(), batch.scene, VeilsForRays{batch.scene},
                           batch.receivers, packets, found, lists, irradiance, BundleLight{});
}

}  // namespace nearlight::core
