// SPDX-License-Identifier: Apache-2.0
#include "host/bench/trace_bench.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <span>
#include <thread>

#include "host/bench/embree_rays.h"
#include "host/bench/statistics.h"
#include "host/bvh/bvh.h"
#include "host/reference/gather_workload.h"
#include "host/stages/ray_caster.h"

namespace nearlight::core {
namespace {

/// Maximum difference between the distances of what counts as the same hit: as a part of the distance, and of
/// the scene's extent, which is what rounding of its coordinates makes.
constexpr float kSameHit = 1e-4f;
constexpr float kRounding = 1e-6f;
/// Maximum fraction of rays that may differ, because both answers are right for rays that graze an edge.
constexpr double kMaxDiffering = 1e-5;

/// One way to trace the rays of a set. It fills in their distances and returns the time that the tracing
/// took.
struct RayContestant {
    std::string name;
    std::function<Seconds(std::vector<float>&)> trace;
};

bool same_hit(float a, float b, float extent) {
    return std::isinf(a) || std::isinf(b) ? a == b
                                          : std::abs(a - b) <= kSameHit * std::max(a, b) + kRounding * extent;
}

std::size_t count_differing(std::span<const float> distances, std::span<const float> truth, float extent) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < truth.size(); ++i) {
        count += same_hit(distances[i], truth[i], extent) ? 0 : 1;
    }
    return count;
}

/// Our kernel with its input.
struct OurTracer {
    OurTracer(Device& on, const Bvh& bvh) : device(&on), caster(on), tree(upload_ray_tree(on, bvh)) {}
    Device* device;
    RayCaster caster;
    DeviceTree tree;
};

RayContestant ours(OurTracer& own, const Buffer<RayQuery>& rays, Buffer<RayHit>& hits) {
    return {"nearlight", [&](std::vector<float>& distances) {
                const TwoClocks clocks(TwoClocks::Of::process);
                own.caster.cast(own.tree, rays, hits);
                own.device->finish();
                const Seconds seconds = clocks.seconds();
                distances.clear();
                for (const RayHit& hit : hits.download()) {
                    distances.push_back(hit.slot == ~0u ? std::numeric_limits<float>::infinity() : hit.t);
                }
                return seconds;
            }};
}

std::vector<RayContestant> embrees(const EmbreeRays& embree, std::span<const RayQuery> rays, int threads) {
    std::vector<RayContestant> contestants;
    for (const EmbreeMode& mode : all_embree_modes()) {
        contestants.push_back(
            {to_string(mode, "rtcIntersect"), [&embree, rays, mode, threads](std::vector<float>& distances) {
                 return embree.trace(rays, mode, threads, distances);
             }});
    }
    return contestants;
}

/// Runs the contestants in turn, and returns the seconds of each contestant's repeats. An additional first
/// round warms up and is not counted. Answers are compared after the last round.
std::vector<std::vector<Seconds>> race(const std::vector<RayContestant>& contestants, int repeats,
                                       float extent, RaySetResult& result) {
    std::vector<std::vector<float>> distances(contestants.size());
    std::vector<std::vector<Seconds>> runs(contestants.size());
    for (int repeat = -1; repeat < repeats; ++repeat) {
        for (std::size_t i = 0; i < contestants.size(); ++i) {
            const Seconds seconds = contestants[i].trace(distances[i]);
            if (repeat >= 0) {
                runs[i].push_back(seconds);
            }
        }
    }
    const std::vector<float>& truth = distances[1];  // rtcIntersect1
    result.hits = static_cast<std::size_t>(
        std::ranges::count_if(truth, [](float distance) { return std::isfinite(distance); }));
    for (std::size_t i = 0; i < contestants.size(); ++i) {
        result.tracers.push_back(
            {contestants[i].name, medians(runs[i]), count_differing(distances[i], truth, extent)});
    }
    return runs;
}

RaySetResult bench_set(OurTracer& own, const EmbreeRays& embree, const std::string& name,
                       std::span<const RayQuery> rays, float extent, const TraceBenchConfig& config) {
    const Buffer<RayQuery> on_device(*own.device, rays);
    Buffer<RayHit> hits(*own.device, rays.size());
    const int cores = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
    std::vector<RayContestant> contestants{ours(own, on_device, hits)};
    std::ranges::move(embrees(embree, rays, config.threads > 0 ? config.threads : cores),
                      std::back_inserter(contestants));
    RaySetResult result{.name = name, .rays = rays.size(), .hits = 0, .tracers = {}, .best = {}};
    const std::vector<std::vector<Seconds>> runs = race(contestants, config.repeats, extent, result);
    const auto max_differing = std::max(1.0, kMaxDiffering * static_cast<double>(rays.size()));
    const auto is_right = [&](const RayTracerFigures& tracer) {
        return static_cast<double>(tracer.differing) <= max_differing;
    };
    // rtcIntersect1, with which all are compared, is the second and always right.
    std::size_t best = 1;
    for (std::size_t i = 2; i < result.tracers.size(); ++i) {
        if (is_right(result.tracers[i]) && result.tracers[i].median.wall < result.tracers[best].median.wall) {
            best = i;
        }
    }
    result.best = result.tracers[best].name;
    result.ratio = ratio(runs[best], runs[0], &Seconds::wall).median;
    result.ratio_processor =
        own.device->is_cpu() ? ratio(runs[best], runs[0], &Seconds::processor).median : 0.0;
    result.agrees = is_right(result.tracers[0]);
    return result;
}

}  // namespace

TraceBenchResult bench_trace(Device& device, const Scene& scene, const TraceBenchConfig& config) {
    const Bvh bvh = build_scene_bvh(scene);
    const std::vector<uint> ids = distinct_triangles(bvh);
    OurTracer own(device, bvh);
    const EmbreeRays embree(scene, ids);
    const float extent = max_component(bounds(scene).size());
    const auto bench = [&](const std::string& name, const std::vector<RayQuery>& rays) {
        return bench_set(own, embree, name, rays, extent, config);
    };
    return {.device = device.name(),
            .triangles = ids.size(),
            .sets = {bench("camera", make_camera_rays(scene, config.width, config.height)),
                     bench("light walks", make_walk_rays(scene, bvh, config.walk_rays))}};
}

}  // namespace nearlight::core
