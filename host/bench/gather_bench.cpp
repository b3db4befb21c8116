// SPDX-License-Identifier: Apache-2.0
#include "host/bench/gather_bench.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>

#include "host/base/log.h"
#include "host/bench/embree_occlusion.h"
#include "host/bench/gather_workload.h"
#include "host/bench/median.h"
#include "host/bvh/wide_bvh.h"

namespace nearlight {
namespace {

constexpr float kClampRadiusShare = 0.01f;  // of the scene's extent; the work does not depend on it

double median_absolute_deviation(const std::vector<double>& values) {
    const double center = median(values);
    std::vector<double> deviations;
    for (const double value : values) {
        deviations.push_back(std::abs(value - center));
    }
    return median(deviations);
}

/// Everything that one gather needs, on the device.
struct GatherJob {
    Buffer<BvhNode> nodes;
    Buffer<BvhTriangle> triangles;
    Buffer<WideNode> wide_nodes;
    Buffer<TriangleBlock> blocks;
    Buffer<Vpl> vpls;
    Buffer<ReceiverPacket> receivers;
    Buffer<IrradiancePacket> irradiance;
    float clamp_radius;

    [[nodiscard]] GatherInput input() const {
        return {nodes,        triangles, wide_nodes,        blocks,      vpls,
                vpls.count(), receivers, receivers.count(), clamp_radius};
    }
};

double seconds_of_gather(Gatherer& gatherer, GatherJob& job) {
    const auto start = std::chrono::steady_clock::now();
    gatherer.gather(job.input(), job.irradiance);
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// The mode that is fastest in one run each.
EmbreeMode best_mode(const EmbreeOcclusion& embree, const OcclusionWork& work, int width, int threads) {
    EmbreeMode best;
    double best_seconds = std::numeric_limits<double>::infinity();
    for (const bool coherent : {false, true}) {
        for (const bool high_quality : {false, true}) {
            const EmbreeMode mode{width, coherent, high_quality};
            const double seconds = embree.trace(work, mode, threads).seconds;
            spdlog::debug("{}: {:.4f} s", to_string(mode), seconds);
            if (seconds < best_seconds) {
                best = mode;
                best_seconds = seconds;
            }
        }
    }
    return best;
}

struct Samples {
    std::vector<double> nearlight, embree1, embree16;  ///< seconds
};

double mrays(std::uint64_t rays, const std::vector<double>& seconds) {
    return static_cast<double>(rays) / median(seconds) * 1e-6;
}

std::vector<double> ratios(const std::vector<double>& seconds, const std::vector<double>& to) {
    std::vector<double> result;
    for (std::size_t i = 0; i < seconds.size(); ++i) {
        result.push_back(seconds[i] / to[i]);
    }
    return result;
}

void compare(GatherBenchResult& result, std::span<const std::uint8_t> record,
             const OcclusionResult& reference) {
    constexpr auto kOccluded = static_cast<std::uint8_t>(GatherPair::occluded);
    std::uint64_t occluded = 0;
    for (std::size_t i = 0; i < record.size(); ++i) {
        const bool ours = record[i] == kOccluded;
        occluded += ours ? 1 : 0;
        result.disagreements += ours != (reference.occluded_pairs[i] != 0) ? 1 : 0;
    }
    result.rays = reference.rays;
    result.occluded_fraction =
        static_cast<double>(occluded) / std::max(1.0, static_cast<double>(result.rays));
}

std::uint64_t count_present(std::span<const ReceiverPacket> packets) {
    std::uint64_t count = 0;
    for (const ReceiverPacket& packet : packets) {
        for (int i = 0; i < NEARLIGHT_PACKET_SIZE; ++i) {
            count += is_zero({packet.nx[i], packet.ny[i], packet.nz[i]}) ? 0 : 1;
        }
    }
    return count;
}

void summarise(GatherBenchResult& result, const Samples& samples) {
    const std::vector<double> ratios16 = ratios(samples.embree16, samples.nearlight);
    result.nearlight_mrays = mrays(result.rays, samples.nearlight);
    result.embree1_mrays = mrays(result.rays, samples.embree1);
    result.embree16_mrays = mrays(result.rays, samples.embree16);
    result.ratio_embree1 = median(ratios(samples.embree1, samples.nearlight));
    result.ratio_embree16 = median(ratios16);
    result.ratio_embree16_deviation = median_absolute_deviation(ratios16);
}

}  // namespace

GatherBenchResult bench_gather(Device& device, const Scene& scene, const Bvh& bvh,
                               const GatherBenchConfig& config) {
    const std::vector<ReceiverPacket> receivers =
        make_camera_receivers(scene, bvh, config.width, config.height);
    const std::vector<Vpl> vpls = make_traced_vpls(scene, bvh, config.vpl_count);
    const WideBvh wide = widen(bvh);
    GatherJob job{Buffer<BvhNode>(device, bvh.nodes),
                  Buffer<BvhTriangle>(device, bvh.triangles),
                  Buffer<WideNode>(device, wide.nodes),
                  Buffer<TriangleBlock>(device, wide.blocks),
                  Buffer<Vpl>(device, vpls),
                  Buffer<ReceiverPacket>(device, receivers),
                  Buffer<IrradiancePacket>(device, receivers.size()),
                  kClampRadiusShare * max_component(bounds(scene).size())};
    Gatherer gatherer(device, config.gather);
    const std::vector<GatherPair> record = gatherer.gather_recorded(job.input(), job.irradiance);
    const std::span record_bytes(reinterpret_cast<const std::uint8_t*>(record.data()), record.size());

    const std::vector<uint> ids = distinct_triangles(bvh);
    const EmbreeOcclusion embree(scene, ids);
    const OcclusionWork work{vpls, receivers, record_bytes};
    const int cores = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
    const int threads = config.threads > 0 ? config.threads : cores;
    GatherBenchResult result;
    result.triangles = ids.size();
    result.device = device.name();
    result.pairs = count_present(receivers) * vpls.size();
    compare(result, record_bytes, embree.trace(work, {1, false, false}, threads, true));
    const EmbreeMode mode1 = best_mode(embree, work, 1, threads);
    const EmbreeMode mode16 = best_mode(embree, work, 16, threads);
    result.embree1_mode = to_string(mode1);
    result.embree16_mode = to_string(mode16);
    seconds_of_gather(gatherer, job);  // compiles and warms up
    Samples samples;
    for (int i = 0; i < config.repeats; ++i) {
        samples.nearlight.push_back(seconds_of_gather(gatherer, job));
        samples.embree16.push_back(embree.trace(work, mode16, threads).seconds);
        samples.embree1.push_back(embree.trace(work, mode1, threads).seconds);
    }
    summarise(result, samples);
    return result;
}

}  // namespace nearlight
