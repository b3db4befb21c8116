// SPDX-License-Identifier: Apache-2.0
#include "host/bench/gather_bench.h"

#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <thread>

#include "host/bench/embree_occlusion.h"
#include "host/stages/roulette.h"

namespace nearlight::core {
namespace {

/// A way to trace a set of segments.
struct Tracer {
    std::string name;
    int embree_width;  ///< rays per call of Embree; 0: our kernels
    bool has_roulette;
    std::function<Seconds()> time;
    std::function<TracerAnswer()> answer;
};

/// The set of segments on the device, for one of our kernels, or for both in turn (`automatic`).
struct DeviceSegments {
    DeviceSegments(Device& device, const GatherSegments& segments, const Bvh& bvh, GatherKernel kernel)
        : tree(kernel == GatherKernel::automatic ? upload_both_trees(device, bvh)
                                                 : upload_tree(device, bvh, kernel)),
          vpls(device, segments.vpls),
          receivers(device, segments.receivers),
          sums(device, segments.receivers.size()),
          roulette(device),
          clamp_radius(segments.clamp_radius) {}

    [[nodiscard]] GatherInput<Vpl> input(const std::optional<VplSelection>& selection) const {
        return {.tree = tree,
                .vpls = vpls,
                .vpl_count = vpls.count(),
                .receivers = receivers,
                .packet_count = receivers.count(),
                .clamp_radius = clamp_radius,
                .selection = selection ? &*selection : nullptr};
    }
    /// The VPLs that each bundle asks about; empty for a threshold of 0, where every bundle asks about all
    /// VPLs.
    [[nodiscard]] std::optional<VplSelection> select(float threshold) {
        return threshold > 0.0f ? std::optional(roulette.select({.vpls = vpls,
                                                                 .vpl_count = vpls.count(),
                                                                 .receivers = receivers,
                                                                 .packet_count = receivers.count(),
                                                                 .clamp_radius = clamp_radius,
                                                                 .threshold = threshold,
                                                                 .seed = 0}))
                                : std::nullopt;
    }

    DeviceTree tree;
    Buffer<Vpl> vpls;
    Buffer<ReceiverPacket> receivers;
    GatherSums<Vpl> sums;
    Roulette roulette;
    float clamp_radius;
};

TracerAnswer to_masks(std::span<const GatherPair> pairs) {
    TracerAnswer answer{PairMask(pairs.size() / NEARLIGHT_PACKET_SIZE),
                        PairMask(pairs.size() / NEARLIGHT_PACKET_SIZE)};
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        const std::size_t lane = i % NEARLIGHT_PACKET_SIZE;
        const bool traced = pairs[i] != GatherPair::culled;
        const bool occluded = pairs[i] == GatherPair::occluded;
        answer.rays[i / NEARLIGHT_PACKET_SIZE] |= std::uint64_t{traced ? 1u : 0u} << lane;
        answer.occluded[i / NEARLIGHT_PACKET_SIZE] |= std::uint64_t{occluded ? 1u : 0u} << lane;
    }
    return answer;
}

Tracer make_own_tracer(Device& device, const std::shared_ptr<DeviceSegments>& job, GatherKernel kernel,
                       float roulette) {
    const auto gatherer = std::make_shared<Gatherer>(device, GatherConfig{.kernel = kernel});
    const auto time = [gatherer, job, roulette] {
        const TwoClocks clocks(TwoClocks::Of::process);
        gatherer->gather(job->input(job->select(roulette)), job->sums);
        return clocks.seconds();
    };
    const auto answer = [gatherer, job, roulette] {
        return to_masks(gatherer->gather_recorded(job->input(job->select(roulette)), job->sums));
    };
    std::string name = kernel == GatherKernel::packets ? "nearlight packets" : "nearlight rays";
    name += roulette > 0.0f ? ", roulette" : "";
    return {std::move(name), 0, roulette > 0.0f, time, answer};
}

Tracer make_embree_tracer(const std::shared_ptr<EmbreeOcclusion>& embree, const GatherSegments& segments,
                          const EmbreeMode& mode, int threads) {
    return {to_string(mode, "rtcOccluded"), mode.width, false,
            [=, &segments] { return embree->trace(segments, mode, threads).seconds; },
            [=, &segments] {
                return TracerAnswer{segments.rays, embree->trace(segments, mode, threads, true).occluded};
            }};
}

/// All tracers. Embree's come first, and the first of them is the reference that all are compared with.
std::vector<Tracer> make_tracers(Device& device, const GatherSegments& segments, const Bvh& bvh,
                                 const GatherBenchConfig& config) {
    std::vector<Tracer> tracers;
    const auto embree = std::make_shared<EmbreeOcclusion>(segments.geometry);
    const int cores = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
    for (const EmbreeMode& mode : all_embree_modes()) {
        tracers.push_back(
            make_embree_tracer(embree, segments, mode, config.threads > 0 ? config.threads : cores));
    }
    const auto job = std::make_shared<DeviceSegments>(device, segments, bvh, config.kernel);
    for (const GatherKernel kernel : {GatherKernel::packets, GatherKernel::rays}) {
        if (config.kernel == GatherKernel::automatic || config.kernel == kernel) {
            tracers.push_back(make_own_tracer(device, job, kernel, 0.0f));
            if (config.roulette > 0.0f) {
                tracers.push_back(make_own_tracer(device, job, kernel, config.roulette));
            }
        }
    }
    return tracers;
}

/// Compares every tracer's answers with those of the reference. This also warms the tracers up.
void compare_answers(const GatherSegments& segments, const Bvh& bvh, std::span<const Tracer> tracers,
                     GatherBenchResult& result) {
    Agreement agreement(segments, bvh.triangles);
    PairMask reference;
    result.agrees = true;
    for (const Tracer& tracer : tracers) {
        TracerAnswer answer = tracer.answer();
        if (reference.empty()) {
            reference = answer.occluded;
        }
        TracerFigures figures{
            .name = tracer.name, .embree_width = tracer.embree_width, .has_roulette = tracer.has_roulette};
        figures.rays = count_bits(answer.rays);
        figures.occluded = count_bits(answer.occluded);
        const AgreementVerdict verdict =
            agreement.compare(tracer.name, answer, reference, tracer.has_roulette);
        figures.disagreements = verdict.differences;
        figures.is_wrong = !verdict.is_rare;
        result.agrees = result.agrees && (tracer.embree_width != 0 || verdict.is_good);
        result.tracers.push_back(std::move(figures));
    }
    result.edge_tolerance = agreement.edge_tolerance();
    result.disagreements = agreement.items();
}

void summarise(GatherBenchResult& result, std::span<const std::vector<Seconds>> runs, bool is_cpu) {
    for (std::size_t i = 0; i < runs.size(); ++i) {
        result.tracers[i].median = medians(runs[i]);
    }
    result.ours = fastest_tracer(result.tracers, 0);
    result.embree1 = fastest_tracer(result.tracers, 1);
    result.embree16 = fastest_tracer(result.tracers, 16);
    const std::vector<Seconds>& ours = runs[result.ours];
    result.wall1 = ratio(runs[result.embree1], ours, &Seconds::wall);
    result.wall16 = ratio(runs[result.embree16], ours, &Seconds::wall);
    if (is_cpu) {
        result.processor1 = ratio(runs[result.embree1], ours, &Seconds::processor);
        result.processor16 = ratio(runs[result.embree16], ours, &Seconds::processor);
    }
    const std::size_t roulette = fastest_tracer(result.tracers, 0, true);
    if (roulette < result.tracers.size()) {
        result.roulette = roulette;
        result.wall_roulette = ratio(runs[result.embree16], runs[roulette], &Seconds::wall);
        if (is_cpu) {
            result.processor_roulette = ratio(runs[result.embree16], runs[roulette], &Seconds::processor);
        }
    }
}

}  // namespace

std::size_t fastest_tracer(std::span<const TracerFigures> tracers, int embree_width, bool has_roulette) {
    std::size_t best = tracers.size();
    const auto is_before = [](const TracerFigures& a, const TracerFigures& b) {
        return a.is_wrong != b.is_wrong ? b.is_wrong : a.median.wall < b.median.wall;
    };
    for (std::size_t i = 0; i < tracers.size(); ++i) {
        if (tracers[i].embree_width == embree_width && tracers[i].has_roulette == has_roulette &&
            (best == tracers.size() || is_before(tracers[i], tracers[best]))) {
            best = i;
        }
    }
    return best;
}

GatherBenchResult bench_gather(Device& device, const GatherSegments& segments, const Bvh& bvh,
                               const GatherBenchConfig& config) {
    const std::vector<Tracer> tracers = make_tracers(device, segments, bvh, config);
    GatherBenchResult result;
    result.triangles = segments.geometry.triangles.size();
    result.device = device.name();
    result.pairs = count_pairs(segments);
    result.after_culling = count_bits(segments.rays);
    compare_answers(segments, bvh, tracers, result);
    std::vector<std::vector<Seconds>> runs(tracers.size());
    for (int repeat = -1; repeat < config.repeats; ++repeat) {
        for (std::size_t i = 0; i < tracers.size(); ++i) {
            const Seconds seconds = tracers[i].time();
            if (repeat >= 0) {  // the first round warms up
                runs[i].push_back(seconds);
            }
        }
    }
    summarise(result, runs, device.is_cpu());
    return result;
}

}  // namespace nearlight::core
