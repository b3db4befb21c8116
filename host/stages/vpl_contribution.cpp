// SPDX-License-Identifier: Apache-2.0
#include "host/stages/vpl_contribution.h"

namespace nearlight {

VplContribution::VplContribution(Device& device)
    : program_(device, "vpl_contribution.cl"), vpl_contribution_(program_, "vpl_contribution") {}

void VplContribution::run(const DeviceScene& scene, const Buffer<Vpl>& vpls, uint vpl_count,
                          const Buffer<ReceiverPacket>& receivers, const Buffer<CameraVertex>& vertices,
                          uint packet_count, float clamp_radius, Buffer<float>& contribution) {
    vpl_contribution_.launch_items(vpl_count, scene.nodes, scene.bvh_triangles, vpls, vpl_count, receivers, vertices,
                                   packet_count, clamp_radius, contribution);
}

}  // namespace nearlight
