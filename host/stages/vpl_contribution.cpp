// SPDX-License-Identifier: Apache-2.0
#include "host/stages/vpl_contribution.h"

namespace nearlight {

VplContribution::VplContribution(Device& device, Gatherer& gatherer)
    : device_(&device),
      gatherer_(&gatherer),
      vpl_light_(device),
      program_(device, "vpl_contribution.cl"),
      vpl_contribution_(program_, "vpl_contribution"),
      vpl_group_contribution_(program_, "vpl_group_contribution") {}

void VplContribution::gather_importance(const DeviceScene& scene, const Importons& importons,
                                        float clamp_radius, const Buffer<ReceiverPacket>& receivers,
                                        Buffer<IrradiancePacket>& importance) {
    gatherer_->gather({.tree = scene.tree,
                       .vpls = importons.vpls,
                       .vpl_count = importons.count,
                       .receivers = receivers,
                       .packet_count = receivers.count(),
                       .clamp_radius = clamp_radius},
                      importance);
}

void VplContribution::run(const DeviceScene& scene, const Buffer<Vpl>& vpls, std::size_t vpl_count,
                          const PilotView& view, float clamp_radius, Buffer<float>& contribution,
                          ContributionNorm norm) {
    const bool squared = norm != ContributionNorm::mean;
    const std::size_t packets = receiver_packet_count(vpl_count);
    Buffer<ReceiverPacket> receivers(*device_, packets);
    Buffer<IrradiancePacket> importance(*device_, packets);
    vpl_light_.make_receivers(vpls, vpl_count, receivers);
    gather_importance(scene, view.importons_of(norm), clamp_radius, receivers, importance);
    vpl_contribution_.launch_items(vpl_count, vpls, static_cast<uint>(vpl_count), importance,
                                   squared ? 1u : 0u, contribution);
    device_->finish();  // the buffers of this function must outlive the kernel
}

std::vector<float> VplContribution::by_group(const DeviceScene& scene, const Buffer<Vpl>& vpls,
                                             std::size_t vpl_count, const PilotView& view,
                                             float clamp_radius) {
    const std::size_t packets = receiver_packet_count(vpl_count);
    const auto group_count = static_cast<uint>(view.importon_groups.size());
    Buffer<ReceiverPacket> receivers(*device_, packets);
    Buffer<IrradiancePacket> importance(*device_, packets);
    Buffer<float> contribution(*device_, 3 * group_count * vpl_count);
    vpl_light_.make_receivers(vpls, vpl_count, receivers);
    for (uint group = 0; group < group_count; ++group) {
        gather_importance(scene, view.importon_groups[group], clamp_radius, receivers, importance);
        vpl_group_contribution_.launch_items(vpl_count, vpls, static_cast<uint>(vpl_count), importance, group,
                                             group_count, contribution);
    }
    return contribution.download();
}

}  // namespace nearlight
