// SPDX-License-Identifier: Apache-2.0
#include "host/stages/vpl_contribution.h"

#include <algorithm>
#include <cmath>

#include "host/base/math.h"
#include "host/stages/joint_programs.h"

namespace nearlight::core {
namespace {

/// The luminance of each VPL times the root of the mean square of its importance.
std::vector<float> errors_of(const Buffer<Vpl>& vpls, std::size_t vpl_count,
                             const Buffer<float>& mean_squares) {
    const std::vector<Vpl> of_vpls = vpls.download();
    std::vector<float> errors = mean_squares.download();
    errors.resize(vpl_count);
    for (std::size_t i = 0; i < vpl_count; ++i) {
        errors[i] = std::sqrt(errors[i]) * luminance(of_vpls[i].power);
    }
    return errors;
}

}  // namespace

VplContribution::VplContribution(Device& device, Gatherer& gatherer)
    : device_(&device),
      gatherer_(&gatherer),
      vpl_light_(device),
      program_(device, "vpl_contribution.cl", kVplsProgram),
      vpl_contribution_(program_, "vpl_contribution"),
      vpl_group_contribution_(program_, "vpl_group_contribution"),
      importance_thresholds_(program_, "importance_thresholds") {}

void VplContribution::run(const DeviceScene& scene, const Buffer<Vpl>& vpls, std::size_t vpl_count,
                          const PilotView& view, float clamp_radius, Buffer<float>& contribution,
                          ContributionNorm norm) {
    const bool squared = norm != ContributionNorm::mean;
    const Importons& importons = view.importons_of(norm);
    const std::size_t packets = receiver_packet_count(vpl_count);
    Buffer<ReceiverPacket> receivers(*device_, packets);
    GatherSums<Importon> importance(*device_, packets);
    vpl_light_.make_receivers(vpls, vpl_count, VplSide::emits, receivers);
    gatherer_->gather({.tree = scene.tree,
                       .vpls = importons.importons,
                       .vpl_count = importons.count,
                       .receivers = receivers,
                       .packet_count = packets,
                       .clamp_radius = clamp_radius,
                       .curves = scene.curves_in_use()},
                      importance);
    vpl_contribution_.launch_items(vpl_count, vpls, static_cast<uint>(vpl_count), importance.light,
                                   squared ? 1u : 0u, contribution);
}

void VplContribution::find_mean_squares(const Buffer<Importon>& importons, std::size_t importon_count,
                                        const Buffer<ReceiverPacket>& receivers, std::size_t packet_count,
                                        float clamp_radius, float part, Buffer<float>& mean_squares) {
    importance_thresholds_.launch_items(
        packet_count * (NEARLIGHT_PACKET_SIZE / 16), importons, static_cast<uint>(importon_count), receivers,
        static_cast<uint>(packet_count), clamp_radius * clamp_radius, part, mean_squares);
}

std::vector<float> VplContribution::unoccluded_errors(const Buffer<Vpl>& vpls, std::size_t vpl_count,
                                                      const PilotView& view, float clamp_radius) {
    const Importons& importons = view.few_squared_importons;
    const std::size_t packets = receiver_packet_count(vpl_count);
    Buffer<ReceiverPacket> receivers(*device_, packets);
    Buffer<float> mean_squares(*device_, packets * NEARLIGHT_PACKET_SIZE);
    vpl_light_.make_receivers(vpls, vpl_count, VplSide::emits, receivers);
    find_mean_squares(importons.importons, importons.count, receivers, packets, clamp_radius, 1.0f,
                      mean_squares);
    return errors_of(vpls, vpl_count, mean_squares);
}

GroupContribution VplContribution::by_group(const DeviceScene& scene, const Buffer<Vpl>& vpls,
                                            std::size_t vpl_count, const PilotView& view,
                                            float clamp_radius) {
    const ImportonGroups& groups = view.importon_groups;
    if (groups.group_count == 0) {
        return {
            .errors = std::vector<float>(vpl_count), .rows = {}, .unoccluded = std::vector<float>(vpl_count)};
    }
    const std::size_t packets = receiver_packet_count(vpl_count);
    Buffer<ReceiverPacket> receivers(*device_, packets);
    GatherSums<Importon> importance(*device_, packets, groups.group_count);
    Buffer<float> errors(*device_, vpl_count);
    Buffer<float> rows(*device_, 3 * groups.group_count * vpl_count);
    Buffer<float> thresholds(*device_, packets * NEARLIGHT_PACKET_SIZE);
    vpl_light_.make_receivers(vpls, vpl_count, VplSide::emits, receivers);
    const std::size_t importon_slots = std::size_t{groups.group_count} * groups.group_size;
    find_mean_squares(groups.importons, importon_slots, receivers, packets, clamp_radius, kNegligiblePart,
                      thresholds);
    gatherer_->gather({.tree = scene.tree,
                       .vpls = groups.importons,
                       .vpl_count = importon_slots,
                       .receivers = receivers,
                       .packet_count = packets,
                       .clamp_radius = clamp_radius,
                       .group_size = groups.group_size,
                       .thresholds = &thresholds,
                       .curves = scene.curves_in_use()},
                      importance);
    vpl_contribution_.launch_items(vpl_count, vpls, static_cast<uint>(vpl_count), importance.squares, 1u,
                                   errors);
    // The scale makes squares of sums over a group comparable with sums of squares.
    const float scale = std::sqrt(static_cast<float>(groups.group_count) /
                                  static_cast<float>(std::max<std::size_t>(groups.importon_count, 1)));
    vpl_group_contribution_.launch_items(vpl_count * groups.group_count, vpls, static_cast<uint>(vpl_count),
                                         importance.groups, groups.group_count, scale, rows);
    return {.errors = errors.download(),
            .rows = rows.download(),
            .unoccluded = errors_of(vpls, vpl_count, thresholds)};
}

}  // namespace nearlight::core
