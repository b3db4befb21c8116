// SPDX-License-Identifier: Apache-2.0
#include "host/samplers/incident_light.h"

#include <span>

#include "host/base/math.h"
#include "host/base/receivers.h"
#include "host/samplers/sparse_walks.h"

namespace nearlight::core {
namespace {

constexpr uint kSparseSeed = 0x5ba5e5u;
/// The sparse set is gathered with this clamp radius, as part of the close range. Large, because a strong VPL
/// beside a point would make that point's power an outlier, and the paths that make up for it are cheap.
constexpr float kClampRadiusToRange = 0.1f;

}  // namespace

SparseSet trace_sparse_set(SamplerStages& stages, const SamplingTask& task, uint wanted, uint seed) {
    SparseSet sparse;
    sparse.clamp_radius = kClampRadiusToRange * task.close_range.range;
    if (task.bounce_count > 1) {
        SamplingTask walks = task;
        walks.bounce_count = task.bounce_count - 1;
        walks.seed = seed ^ kSparseSeed;
        const std::vector<Vpl> vpls =
            trace_about(stages, walks, empty_region(stages, task.scene), KeepDeposits::all, wanted).vpls;
        sparse.count = vpls.size();
        sparse.vpls = stages.vpl_order.upload_sorted(vpls);
    }
    return sparse;
}

void gather_incident_light(SamplerStages& stages, const SamplingTask& task, const SparseSet& sparse,
                           const Buffer<ReceiverPacket>& receivers, std::size_t packet_count,
                           const IncidentQuality& quality, uint seed, Buffer<IrradiancePacket>& irradiance) {
    stages.direct_light.run(task.scene, receivers, packet_count, quality.direct_samples, seed, irradiance);
    if (task.bounce_count < 2) {
        return;
    }
    if (sparse.count > 0) {
        Buffer<IrradiancePacket> gathered(stages.device, packet_count);
        stages.gatherer.gather({.tree = task.scene.tree,
                                .vpls = sparse.vpls,
                                .vpl_count = sparse.count,
                                .receivers = receivers,
                                .packet_count = packet_count,
                                .clamp_radius = sparse.clamp_radius},
                               gathered);
        stages.vpl_light.add(gathered, packet_count, irradiance);
        stages.device.finish();  // `gathered` must outlive the kernel
    }
    const BouncePaths paths{.sample_count = quality.paths,
                            .bounce_count = task.bounce_count - 1,
                            .clamp_radius = sparse.clamp_radius,
                            .seed = seed ^ kSparseSeed};
    stages.bounce_tracer.run(task.scene, receivers, packet_count, paths, irradiance);
}

std::vector<Vec3> unpack(const Buffer<IrradiancePacket>& buffer, std::size_t count) {
    const std::vector<IrradiancePacket> packets = buffer.download();
    std::vector<Vec3> values;
    values.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        values.push_back(irradiance_at(packets, i));
    }
    return values;
}

std::vector<Vec3> incident_light_at(SamplerStages& stages, const SamplingTask& task, const SparseSet& sparse,
                                    std::span<const Vpl> points, const IncidentQuality& quality, uint seed) {
    const std::size_t packets = receiver_packet_count(points.size());
    const Buffer<Vpl> vpls(stages.device, points);
    Buffer<ReceiverPacket> receivers(stages.device, packets);
    Buffer<IrradiancePacket> irradiance(stages.device, packets);
    stages.vpl_light.make_receivers(vpls, points.size(), receivers);
    gather_incident_light(stages, task, sparse, receivers, packets, quality, seed, irradiance);
    return unpack(irradiance, points.size());
}

void illuminate(std::span<Vpl> vpls, std::span<const Vec3> irradiance) {
    for (std::size_t i = 0; i < vpls.size(); ++i) {
        vpls[i].power *= irradiance[i];
    }
}

}  // namespace nearlight::core
