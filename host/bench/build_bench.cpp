// SPDX-License-Identifier: Apache-2.0
#include "host/bench/build_bench.h"

#include <algorithm>
#include <functional>
#include <thread>

#include "host/bench/embree_trees.h"
#include "host/bench/statistics.h"
#include "host/reference/gather_workload.h"

namespace nearlight::core {
namespace {

struct TreeWork {
    std::vector<Vpl> vpls;
    std::vector<ReceiverPacket> receivers;
};

TreeWork make_tree_work(const Scene& scene, const Bvh& bvh, const BuildBenchConfig& config) {
    const std::vector<ReceiverPacket> all = make_camera_receivers(scene, bvh, config.width, config.height);
    TreeWork work;
    work.vpls = make_traced_vpls(scene, bvh, config.vpl_count);
    for (std::size_t i = 0; i < all.size(); i += static_cast<std::size_t>(std::max(1, config.tile_stride))) {
        work.receivers.push_back(all[i]);
    }
    return work;
}

/// One way to build a tree.
struct Contender {
    std::string name;
    std::function<Seconds()> measure;  ///< builds a tree and returns the seconds that it took
    std::function<Bvh()> build;
    std::vector<Seconds> seconds;
};

std::vector<Contender> contenders(const Scene& scene, std::span<const uint> ids, const BvhConfig& config) {
    std::vector<Contender> result;
    for (const BvhQuality quality : {BvhQuality::fast, BvhQuality::quality}) {
        BvhConfig own = config;
        own.quality = quality;
        const auto build = [&scene, ids, own] { return build_bvh(scene, ids, own); };
        const auto measure = [build] {
            const TwoClocks clocks(TwoClocks::Of::process);
            const Bvh bvh = build();
            return clocks.seconds();
        };
        result.push_back({std::string("nearlight ") + to_string(quality), measure, build, {}});
    }
    for (const EmbreeQuality quality : {EmbreeQuality::medium, EmbreeQuality::high}) {
        result.push_back(
            {quality == EmbreeQuality::high ? "Embree high" : "Embree medium",
             [&scene, ids, quality] { return seconds_of_embree_build(scene, ids, quality); },
             [&scene, ids, quality, config] { return build_embree_bvh(scene, ids, quality, config); },
             {}});
    }
    return result;
}

BuiltTree describe(const Contender& contender, std::size_t triangles, const TreeWork& work, int threads) {
    const Bvh bvh = contender.build();
    BuiltTree tree;
    tree.name = contender.name;
    tree.seconds = medians(contender.seconds);
    tree.sah_cost = bvh.sah_cost;
    tree.nodes = bvh.nodes.size();
    tree.duplication = static_cast<double>(bvh.triangles.size()) / static_cast<double>(triangles) - 1.0;
    tree.depth = bvh.depth;
    tree.steps = count_steps(bvh, work.vpls, work.receivers, threads);
    return tree;
}

}  // namespace

BuildBenchResult bench_build(const Scene& scene, const BuildBenchConfig& config) {
    const Bvh first = build_scene_bvh(scene);
    const std::vector<uint> ids = distinct_triangles(first);
    const TreeWork work = make_tree_work(scene, first, config);
    const int cores = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
    std::vector<Contender> all = contenders(scene, ids, config.bvh);
    for (int i = 0; i < config.repeats; ++i) {
        for (Contender& contender : all) {
            contender.seconds.push_back(contender.measure());
        }
    }
    BuildBenchResult result;
    result.triangles = ids.size();
    for (const Contender& contender : all) {
        result.trees.push_back(
            describe(contender, ids.size(), work, config.threads > 0 ? config.threads : cores));
    }
    const TreeSteps& ours = result.trees[1].steps;
    const TreeSteps& theirs = result.trees[3].steps;
    result.ratio_seconds = ratio(all[1].seconds, all[3].seconds, &Seconds::wall).median;
    result.ratio_processor_seconds = ratio(all[1].seconds, all[3].seconds, &Seconds::processor).median;
    result.ratio_ray_steps =
        (ours.nodes_per_ray + ours.triangles_per_ray) / (theirs.nodes_per_ray + theirs.triangles_per_ray);
    result.ratio_packet_steps = (ours.nodes_per_packet + ours.triangles_per_packet) /
                                (theirs.nodes_per_packet + theirs.triangles_per_packet);
    return result;
}

}  // namespace nearlight::core
