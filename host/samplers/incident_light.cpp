// SPDX-License-Identifier: Apache-2.0
#include "host/samplers/incident_light.h"

#include <span>

#include "host/samplers/sparse_walks.h"

namespace nearlight {
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
        stages.gatherer.gather({.nodes = task.scene.nodes,
                                .triangles = task.scene.bvh_triangles,
                                .vpls = sparse.vpls,
                                .vpl_count = sparse.count,
                                .receivers = receivers,
                                .packet_count = packet_count,
                                .clamp_radius = sparse.clamp_radius},
                               gathered);
        stages.vpl_light.add(gathered, packet_count, irradiance);
        stages.device.finish();  // `gathered` must outlive the kernel
    }
    const BouncePaths paths{.sample_count = quality.short_paths,
                            .bounce_count = task.bounce_count - 1,
                            .clamp_radius = sparse.clamp_radius,
                            .seed = seed ^ kSparseSeed};
    stages.bounce_tracer.run(task.scene, receivers, packet_count, paths, irradiance);
}

}  // namespace nearlight
