// SPDX-License-Identifier: Apache-2.0
// Measures how long our trees and Embree's take to build, and how many steps rays take through them.
#pragma once

#include <string>
#include <vector>

#include "host/bench/seconds.h"
#include "host/bench/tree_steps.h"
#include "host/bvh/bvh.h"
#include "host/scene/scene.h"

namespace nearlight::core {

struct BuildBenchConfig {
    std::size_t vpl_count = 32;  ///< VPLs of the segments on which steps are counted
    int width = 512;  ///< receivers: pixels of a picture of this size, from every tile_stride-th tile
    int height = 512;
    int tile_stride = 16;
    int repeats = 5;
    int threads = 0;  ///< threads that count steps; 0: one per core
    BvhConfig bvh;    ///< settings of our trees, of both qualities
};

/// The figures of one tree. The same code counts the steps of all trees over the same segments, and costs are
/// in the same units. `seconds` is the time that Embree takes for its own kind of tree; steps are counted on
/// the binary tree that rtcBuildBVH() makes.
struct BuiltTree {
    std::string name;
    Seconds seconds;  ///< medians of interleaved builds with all threads
    double sah_cost = 0.0;
    std::size_t nodes = 0;
    double duplication = 0.0;  ///< entries in leaves ÷ triangles, minus 1
    int depth = 0;
    TreeSteps steps;
};

struct BuildBenchResult {
    std::size_t triangles = 0;
    std::vector<BuiltTree> trees;  ///< our fast and quality trees, then Embree's medium and high
    double ratio_seconds = 0.0;    ///< our quality ÷ Embree's high: median of the ratios of all repeats
    double ratio_processor_seconds = 0.0;  ///< as ratio_seconds, by processor time
    double ratio_ray_steps = 0.0;          ///< our quality ÷ Embree's high, nodes and triangles together
    double ratio_packet_steps = 0.0;       ///< as ratio_ray_steps, for packets
};

BuildBenchResult bench_build(const Scene& scene, const BuildBenchConfig& config = {});

}  // namespace nearlight::core
