// SPDX-License-Identifier: Apache-2.0
// Measures the trees: how long they take to build, and what they are worth, beside Embree's.
#pragma once

#include <string>
#include <vector>

#include "host/bench/tree_steps.h"
#include "host/bvh/bvh.h"
#include "host/scene/scene.h"

namespace nearlight::core {

struct BuildBenchConfig {
    std::size_t vpl_count = 32;  ///< of the segments by which steps are counted
    int width = 512;             ///< receivers: pixels of a picture of this size, every n-th tile of it
    int height = 512;
    int tile_stride = 16;
    int repeats = 5;
    int threads = 0;  ///< that count; 0: as many as there are cores
    BvhConfig bvh;    ///< of both qualities
};

/// One tree. Steps of all trees are counted by the same program over the same segments; costs are in the same
/// units. Embree builds a tree of its own for tracing (`seconds`) and by rtcBuildBVH() a binary one, which is
/// what is counted.
struct BuiltTree {
    std::string name;
    double seconds = 0.0;  ///< median of interleaved builds, by all threads
    double sah_cost = 0.0;
    std::size_t nodes = 0;
    double duplication = 0.0;  ///< entries in leaves ÷ triangles, minus 1
    int depth = 0;
    TreeSteps steps;
};

struct BuildBenchResult {
    std::size_t triangles = 0;
    std::vector<BuiltTree> trees;  ///< ours fast and quality, Embree medium and high
    double ratio_seconds = 0.0;    ///< our quality ÷ Embree high: median of the ratios of each repeat
    double ratio_ray_steps = 0.0;  ///< of nodes and triangles
    double ratio_packet_steps = 0.0;
};

BuildBenchResult bench_build(const Scene& scene, const BuildBenchConfig& config = {});

}  // namespace nearlight::core
