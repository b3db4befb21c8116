// SPDX-License-Identifier: Apache-2.0
#include "host/stages/vpl_contribution.h"

namespace nearlight {

VplContribution::VplContribution(Device& device, Gatherer& gatherer)
    : device_(&device),
      gatherer_(&gatherer),
      vpl_light_(device),
      program_(device, "vpl_contribution.cl"),
      vpl_contribution_(program_, "vpl_contribution") {}

void VplContribution::run(const DeviceScene& scene, const Buffer<Vpl>& vpls, std::size_t vpl_count,
                          const PilotView& view, float clamp_radius, Buffer<float>& contribution,
                          ContributionNorm norm) {
    const bool squared = norm != ContributionNorm::mean;
    const Importons& importons = view.importons_of(norm);
    const std::size_t packets = receiver_packet_count(vpl_count);
    Buffer<ReceiverPacket> receivers(*device_, packets);
    Buffer<IrradiancePacket> importance(*device_, packets);
    vpl_light_.make_receivers(vpls, vpl_count, receivers);
    gatherer_->gather({.tree = scene.tree,
                       .vpls = importons.vpls,
                       .vpl_count = importons.count,
                       .receivers = receivers,
                       .packet_count = packets,
                       .clamp_radius = clamp_radius},
                      importance);
    vpl_contribution_.launch_items(vpl_count, vpls, static_cast<uint>(vpl_count), importance,
                                   squared ? 1u : 0u, contribution);
    device_->finish();  // the buffers of this function must outlive the kernel
}

}  // namespace nearlight
