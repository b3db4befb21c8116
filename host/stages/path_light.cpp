// SPDX-License-Identifier: Apache-2.0
#include "host/stages/path_light.h"

namespace nearlight {

PathLight::PathLight(Device& device)
    : program_(device, "path_light.cl"), path_light_(program_, "path_light") {}

void PathLight::run(const DeviceScene& scene, const Buffer<ReceiverPacket>& receivers,
                    std::size_t packet_count, const SparseVpls& sparse, const LightPaths& paths,
                    Buffer<IrradiancePacket>& irradiance) {
    path_light_.launch_items(packet_count * NEARLIGHT_PACKET_SIZE, scene, receivers,
                             static_cast<uint>(packet_count), sparse.vpls, static_cast<uint>(sparse.count),
                             paths.connections, sparse.radius, paths.path_count, paths.bounce_count,
                             paths.direct_samples, paths.seed, irradiance);
}

}  // namespace nearlight
