// SPDX-License-Identifier: Apache-2.0
#include "host/bench/embree_rays.h"

#include <algorithm>
#include <atomic>
#include <limits>
#include <thread>

#include "host/bench/embree_tree_pair.h"

namespace nearlight::core {
namespace {

/// Number of rays that are laid out at a time: few enough to stay in the cache.
constexpr std::size_t kRaysAtOnce = 4096;

RTCRayHit one_ray(const RayQuery& query) {
    RTCRayHit hit{};
    hit.ray.org_x = query.origin.x;
    hit.ray.org_y = query.origin.y;
    hit.ray.org_z = query.origin.z;
    hit.ray.dir_x = query.direction.x;
    hit.ray.dir_y = query.direction.y;
    hit.ray.dir_z = query.direction.z;
    hit.ray.tnear = query.t_min;
    hit.ray.tfar = query.t_max;
    hit.ray.mask = ~0u;
    hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    return hit;
}

void set_lane(RTCRayHit16& packet, std::size_t lane, const RayQuery& query) {
    packet.ray.org_x[lane] = query.origin.x;
    packet.ray.org_y[lane] = query.origin.y;
    packet.ray.org_z[lane] = query.origin.z;
    packet.ray.dir_x[lane] = query.direction.x;
    packet.ray.dir_y[lane] = query.direction.y;
    packet.ray.dir_z[lane] = query.direction.z;
    packet.ray.tnear[lane] = query.t_min;
    packet.ray.tfar[lane] = query.t_max;
    packet.ray.mask[lane] = ~0u;
    packet.hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
}

float distance(unsigned geometry, float t) {
    return geometry == RTC_INVALID_GEOMETRY_ID ? std::numeric_limits<float>::infinity() : t;
}

/// Traces rays one by one, and adds the time of the calls to `seconds`.
void trace_singles(RTCScene tree, EmbreeQuery& query, std::span<const RayQuery> rays,
                   std::span<float> distances, Seconds& seconds) {
    std::vector<RTCRayHit> singles(rays.size());
    std::ranges::transform(rays, singles.begin(), one_ray);
    const TwoClocks clocks(TwoClocks::Of::thread);
    for (RTCRayHit& single : singles) {
        query.intersect(tree, single);
    }
    const Seconds taken = clocks.seconds();
    seconds.wall += taken.wall;
    seconds.processor += taken.processor;
    std::ranges::transform(singles, distances.begin(), [](const RTCRayHit& single) {
        return distance(single.hit.geomID, single.ray.tfar);
    });
}

void trace_packets(RTCScene tree, EmbreeQuery& query, std::span<const RayQuery> rays,
                   std::span<float> distances, Seconds& seconds) {
    std::vector<RTCRayHit16> packets((rays.size() + 15) / 16);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        set_lane(packets[i / 16], i % 16, rays[i]);
    }
    alignas(64) int all[16];
    alignas(64) int last[16];
    for (std::size_t lane = 0; lane < 16; ++lane) {
        all[lane] = -1;
        last[lane] = lane < rays.size() - (packets.size() - 1) * 16 ? -1 : 0;
    }
    const TwoClocks clocks(TwoClocks::Of::thread);
    for (RTCRayHit16& packet : packets) {
        query.intersect(&packet == &packets.back() ? last : all, tree, packet);
    }
    const Seconds taken = clocks.seconds();
    seconds.wall += taken.wall;
    seconds.processor += taken.processor;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const RTCRayHit16& packet = packets[i / 16];
        distances[i] = distance(packet.hit.geomID[i % 16], packet.ray.tfar[i % 16]);
    }
}

}  // namespace

struct EmbreeRays::State {
    State(const Scene& scene, std::span<const uint> ids) : trees(scene, ids) {}
    EmbreeTreePair trees;
};

EmbreeRays::EmbreeRays(const Scene& scene, std::span<const uint> ids)
    : state_(std::make_unique<State>(scene, ids)) {}

EmbreeRays::~EmbreeRays() = default;

Seconds EmbreeRays::trace(std::span<const RayQuery> rays, const EmbreeMode& mode, int threads,
                          std::vector<float>& distances) const {
    RTCScene tree = state_->trees.tree(mode);
    distances.resize(rays.size());
    std::vector<Seconds> seconds(static_cast<std::size_t>(threads));
    std::atomic<std::size_t> next = 0;
    const auto work = [&](Seconds& own) {
        EmbreeQuery query(mode.coherent);
        for (std::size_t first = next.fetch_add(kRaysAtOnce); first < rays.size();
             first = next.fetch_add(kRaysAtOnce)) {
            const std::size_t count = std::min(kRaysAtOnce, rays.size() - first);
            const auto trace = mode.width == 1 ? trace_singles : trace_packets;
            trace(tree, query, rays.subspan(first, count), std::span(distances).subspan(first, count), own);
        }
    };
    std::vector<std::thread> workers;
    for (Seconds& own : seconds) {
        workers.emplace_back(work, std::ref(own));
    }
    Seconds sum;
    for (std::size_t i = 0; i < workers.size(); ++i) {
        workers[i].join();
        sum.wall += seconds[i].wall / threads;
        sum.processor += seconds[i].processor;
    }
    return sum;
}

}  // namespace nearlight::core
