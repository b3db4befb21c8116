// SPDX-License-Identifier: Apache-2.0
#include "host/stages/shared_sky.h"

#include <limits>

#include "host/stages/joint_programs.h"

namespace nearlight::core {

SharedSky::SharedSky(Device& device)
    : program_(device, "shared_sky.cl", kViewProgram), gather_(program_, "shared_sky_gather") {}

void SharedSky::add(const ReceiverBatch& batch, SharedLightLists& lists, const Buffer<SharedLight>& found,
                    const SeenSurfaces& seen, Buffer<IrradiancePacket>& irradiance) {
    const ReceiverPathSettings& settings = batch.settings;
    lists.make(batch, std::numeric_limits<float>::infinity(), found, NEARLIGHT_SHARED_SKY_LIGHTS,
               Hiding::solids);
    gather_.launch_items(batch.packet_count * NEARLIGHT_PACKET_SIZE, batch.scene, VeilsForRays{batch.scene},
                         batch.receivers, static_cast<uint>(batch.packet_count), found, lists,
                         settings.path_count, settings.light_samples, settings.max_edges, irradiance,
                         seen.surfaces.count() > 0 ? 1u : 0u, seen.rays, seen.surfaces, seen.vertices);
}

}  // namespace nearlight::core
