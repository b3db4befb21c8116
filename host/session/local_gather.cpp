// SPDX-License-Identifier: Apache-2.0
#include "host/session/local_gather.h"

namespace nearlight::core {

void LocalGather::set_vpls(const DeviceScene& scene, const VplBuffer& vpls, const LocalLightPlan& plan) {
    vpls_ = lights_.group(scene, vpls.download(), plan);
    plan_ = plan;
    light_count_ = 0;
}

bool LocalGather::run(Gatherer& gatherer, const DeviceScene& scene, const Buffer<ReceiverPacket>& receivers,
                      std::size_t packet_count, const VplStrata& strata, GatherSums<Vpl>& sums,
                      const GatherProgress& progress) {
    GatherSums<Vpl> part(*device_, packet_count);
    sums.light.fill_zero();
    std::uint64_t pairs_before = 0;
    const std::uint64_t receiver_count = packet_count * NEARLIGHT_PACKET_SIZE;
    for (const LocalVpls::Group& group : vpls_.groups) {
        // The gatherer counts the pairs of a stratum, and all strata together are the whole.
        const auto of_group = [&](std::uint64_t done, std::uint64_t total) {
            const double part_done = total > 0 ? static_cast<double>(done) / static_cast<double>(total) : 1.0;
            const auto pairs = static_cast<double>(group.count * receiver_count);
            return !progress || progress(pairs_before + static_cast<std::uint64_t>(part_done * pairs),
                                         vpls_.count * receiver_count);
        };
        const bool finished = gatherer.gather({.tree = scene.tree,
                                               .vpls = group.vpls,
                                               .vpl_count = group.count,
                                               .receivers = receivers,
                                               .packet_count = packet_count,
                                               .clamp_radius = group.radius,
                                               .strata = &strata,
                                               .curves = scene.curves_in_use(),
                                               .has_maps = scene.has_maps()},
                                              part, of_group);
        if (!finished) {
            return false;
        }
        vpl_light_.add(part.light, packet_count, sums.light);
        pairs_before += group.count * receiver_count;
    }
    light_count_ += lights_.add(scene, vpls_, receivers, packet_count, plan_, sums.light);
    return true;
}

}  // namespace nearlight::core
