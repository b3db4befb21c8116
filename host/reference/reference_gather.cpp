// SPDX-License-Identifier: Apache-2.0
#include "host/reference/reference_gather.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include "host/base/fork_join.h"
#include "host/base/receivers.h"
#include "host/base/seen_normal.h"
#include "host/reference/arena_size.h"
#include "host/reference/light_sampler.h"

namespace nearlight::core {
namespace {

Vec3 vpl_irradiance(const EmbreeScene& embree, const Vpl& vpl, float clamp_radius, Vec3 position,
                    Vec3 normal) {
    const Vec3 segment = position - vpl.position;
    const float distance2 = dot(segment, segment);
    if (!(distance2 > 0.0f)) {
        return {0, 0, 0};
    }
    const float scale = 1.0f / distance2;  // the cosines below are multiplied by the length of the segment
    const float cosines =
        std::max(0.0f, -dot(normal, segment)) * std::max(0.0f, dot(vpl.normal, segment)) * scale;
    const bool is_seen = dot(seen_normal(vpl), segment) > 0.0f;
    if (!(cosines > 0.0f) || !is_seen || embree.blocked(vpl.position, position)) {
        return {0, 0, 0};
    }
    return vpl.power * (cosines / (kPi * std::max(distance2, clamp_radius * clamp_radius)));
}

/// Sums `term(position, normal, i)` over all i < count for every receiver.
template <typename Term>
void sum_terms(std::span<const ReceiverPacket> receivers, std::span<IrradiancePacket> irradiance, int threads,
               std::size_t count, const Term& term) {
    const auto sum_one = [&](std::size_t index) {
        const std::size_t lane = index % NEARLIGHT_PACKET_SIZE;
        const auto [position, normal] = receiver_at(receivers, index);
        double sum[3] = {0, 0, 0};
        for (std::size_t i = 0; i < count && !is_zero(normal); ++i) {
            const Vec3 e = term(position, normal, i);
            sum[0] += e.x;
            sum[1] += e.y;
            sum[2] += e.z;
        }
        IrradiancePacket& out = irradiance[index / NEARLIGHT_PACKET_SIZE];
        out.r[lane] = static_cast<float>(sum[0]);
        out.g[lane] = static_cast<float>(sum[1]);
        out.b[lane] = static_cast<float>(sum[2]);
    };
    tbb::task_arena arena(arena_size(threads));
    arena.execute([&] {
        ForkJoin fork;
        tbb::parallel_for(std::size_t{0}, receivers.size() * NEARLIGHT_PACKET_SIZE, fork.task(sum_one));
    });
}

}  // namespace

void gather_reference(const EmbreeScene& embree, std::span<const Vpl> vpls, float clamp_radius,
                      std::span<const ReceiverPacket> receivers, std::span<IrradiancePacket> irradiance,
                      int threads) {
    sum_terms(receivers, irradiance, threads, vpls.size(), [&](Vec3 position, Vec3 normal, std::size_t i) {
        return vpl_irradiance(embree, vpls[i], clamp_radius, position, normal);
    });
}

std::vector<Vpl> as_vpls(std::span<const Importon> importons) {
    std::vector<Vpl> vpls;
    vpls.reserve(importons.size());
    for (const Importon& importon : importons) {
        vpls.push_back({.position = importon.position,
                        .depth = 0,
                        .normal = importon.normal,
                        .flags = importon.flags,
                        .power = importon.response,
                        .shading = 0});
    }
    return vpls;
}

void direct_reference(const EmbreeScene& embree, const Scene& scene,
                      std::span<const ReceiverPacket> receivers, std::span<IrradiancePacket> irradiance,
                      int threads) {
    const std::vector<Emitter>& lights = scene.delta_emitters;
    sum_terms(receivers, irradiance, threads, lights.size(), [&](Vec3 position, Vec3 normal, std::size_t i) {
        return delta_light_irradiance(scene, embree, lights[i], position, normal);
    });
}

}  // namespace nearlight::core
