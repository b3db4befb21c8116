// SPDX-License-Identifier: Apache-2.0
#include "host/stages/shared_sky.h"

namespace nearlight::core {

SharedSky::SharedSky(Device& device)
    : program_(device, "shared_sky.cl"), gather_(program_, "shared_sky_gather") {}

void SharedSky::add(const ReceiverBatch& batch, SharedLightLists& lists, const Buffer<SharedLight>& found,
                    const SeenSurfaces& seen, Buffer<IrradiancePacket>& irradiance) {
    lists.make(
        batch,
        {.shares = NEARLIGHT_SHARES_SKY, .count = NEARLIGHT_SHARED_SKY_LIGHTS, .hiding = Hiding::solids},
        found);
    const SharedSkyParams params{.packet_count = static_cast<uint>(batch.packet_count),
                                 .rays = batch.settings.rays,
                                 .light_samples = batch.settings.light_samples,
                                 .max_edges = batch.settings.max_edges,
                                 .has_seen = seen.surfaces.count() > 0 ? 1u : 0u,
                                 .seen_rays = seen.rays,
                                 .pad0 = 0,
                                 .pad1 = 0};
    gather_.launch_items(batch.packet_count * NEARLIGHT_PACKET_SIZE, batch.scene, VeilsForRays{batch.scene},
                         batch.receivers, params, found, lists, irradiance, seen.surfaces, seen.vertices);
}

}  // namespace nearlight::core
