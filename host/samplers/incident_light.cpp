// SPDX-License-Identifier: Apache-2.0
#include "host/samplers/incident_light.h"

#include <algorithm>
#include <span>

#include "host/base/math.h"
#include "host/base/random.h"
#include "host/base/receivers.h"
#include "host/samplers/candidates.h"
#include "host/samplers/sparse_walks.h"

namespace nearlight::core {
namespace {

constexpr uint kSparseSeed = 0x5ba5e5u;
constexpr uint kSparseStream = 0xd4a3u;
constexpr uint kDepositsPerSparseVpl = 64;
/// Bounds of the number of deposits. For more VPLs than the maximum allows, there are fewer deposits per VPL.
constexpr uint kMinSparseDeposits = 1u << 15u;
constexpr uint kMaxSparseDeposits = 1u << 20u;
/// The clamp radius that the sparse set is gathered with, as a part of the range. It is large because a
/// strong VPL beside a point would make that point's power an outlier, and the paths that supply the missing
/// light are cheap.
constexpr float kSparseRadiusToRange = 0.1f;

template <typename Packet>
std::vector<Vec3> first_lanes(const Buffer<Packet>& buffer, std::size_t count) {
    const std::vector<Packet> packets = buffer.download();
    std::vector<Vec3> values;
    values.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        values.push_back(arrived_at(std::span<const Packet>(packets), i));
    }
    return values;
}

}  // namespace

SparseSet draw_sparse_set(SamplerStages& stages, const SamplingTask& task, std::span<const Vpl> deposits,
                          std::span<const float> weights, std::size_t wanted, uint seed) {
    SparseSet sparse;
    sparse.clamp_radius = kSparseRadiusToRange * task.close_range.range;
    if (task.bounce_count > 1) {
        std::vector<float> usable(weights.begin(), weights.end());
        for (std::size_t i = 0; i < usable.size(); ++i) {
            usable[i] = deposits[i].depth < task.bounce_count ? usable[i] : 0.0f;
        }
        const double shift = Pcg32(seed, kSparseStream).uniform();
        sparse.vpls = stages.vpl_order.sort(take(resample(usable, wanted, shift), deposits));
    }
    return sparse;
}

SparseSet trace_sparse_set(SamplerStages& stages, const SamplingTask& task, uint wanted, uint seed) {
    if (task.bounce_count <= 1) {
        return draw_sparse_set(stages, task, {}, {}, 0, seed);
    }
    SamplingTask walks = task;
    walks.bounce_count = task.bounce_count - 1;
    walks.seed = seed ^ kSparseSeed;
    const uint wanted_deposits = std::clamp(wanted, kMinSparseDeposits / kDepositsPerSparseVpl,
                                            kMaxSparseDeposits / kDepositsPerSparseVpl) *
                                 kDepositsPerSparseVpl;
    const std::vector<Vpl> deposits =
        stages.vpl_order.sorted(trace_about(stages, walks, empty_region(stages, task.scene),
                                            KeepDeposits::all, std::max(wanted, wanted_deposits))
                                    .vpls);
    const std::vector<float> weights =
        choice_weights(stages, task, deposits, ContributionNorm::error_of_draw);
    return draw_sparse_set(stages, task, deposits, weights, wanted, seed);
}

void gather_incident_light(SamplerStages& stages, const IncidentSources& sources,
                           const Buffer<ReceiverPacket>& receivers, std::size_t packet_count,
                           const IncidentQuality& quality, uint seed, Buffer<IrradiancePacket>& irradiance) {
    const DeviceScene& scene = sources.scene;
    Buffer<IrradiancePacket> indirect(stages.device, packet_count);
    stages.receiver_paths.run({scene,
                               receivers,
                               packet_count,
                               {.light_samples = quality.direct_samples,
                                .rays = quality.paths,
                                .max_edges = sources.bounce_count + 1,
                                .clamp_radius = sources.clamp_radius,
                                .seed = seed}},
                              irradiance, indirect);
    stages.vpl_light.add(indirect, packet_count, irradiance);
    if (!sources.vpls.empty()) {
        GatherSums<Vpl> gathered(stages.device, packet_count);
        stages.gatherer.gather({.tree = scene.tree,
                                .vpls = sources.vpls.buffer(),
                                .vpl_count = sources.vpls.count(),
                                .receivers = receivers,
                                .packet_count = packet_count,
                                .clamp_radius = sources.clamp_radius,
                                .curves = scene.curves_in_use(),
                                .has_maps = scene.has_maps()},
                               gathered);
        stages.vpl_light.add(gathered.light, packet_count, irradiance);
    }
}

std::vector<Vec3> unpack(const Buffer<IrradiancePacket>& packets, std::size_t count) {
    return first_lanes(packets, count);
}
std::vector<Vec3> unpack(const Buffer<ImportancePacket>& packets, std::size_t count) {
    return first_lanes(packets, count);
}

std::vector<Vec3> incident_light_at(SamplerStages& stages, const SamplingTask& task, const SparseSet& sparse,
                                    std::span<const Vpl> points, const IncidentQuality& quality, uint seed) {
    const std::size_t packets = receiver_packet_count(points.size());
    const Buffer<Vpl> vpls(stages.device, points);
    Buffer<ReceiverPacket> receivers(stages.device, packets);
    Buffer<IrradiancePacket> irradiance(stages.device, packets);
    stages.vpl_light.make_receivers(vpls, points.size(), VplSide::receives, receivers);
    const IncidentSources sources{.scene = task.scene,
                                  .bounce_count = task.bounce_count > 0 ? task.bounce_count - 1 : 0,
                                  .vpls = sparse.vpls,
                                  .clamp_radius = sparse.clamp_radius};
    gather_incident_light(stages, sources, receivers, packets, quality, seed, irradiance);
    return unpack(irradiance, points.size());
}

void illuminate(std::span<Vpl> vpls, std::span<const Vec3> irradiance) {
    for (std::size_t i = 0; i < vpls.size(); ++i) {
        vpls[i].power *= irradiance[i];
    }
}

}  // namespace nearlight::core
