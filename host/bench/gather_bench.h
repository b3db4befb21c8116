// SPDX-License-Identifier: Apache-2.0
// Measures the gather against Embree on the very same rays.
#pragma once

#include <string>
#include <vector>

#include "host/bvh/bvh.h"
#include "host/cl/device.h"
#include "host/scene/scene.h"
#include "host/stages/gatherer.h"

namespace nearlight {

struct GatherBenchConfig {
    std::size_t vpl_count = 128;
    int width = 512;  ///< receivers: pixels
    int height = 512;
    int repeats = 11;
    int threads = 0;  ///< Embree's; 0: as many as there are cores
    GatherConfig gather;
};

/// Rates are medians over the repeats, in millions of rays (pairs that survive culling) a second of wall
/// clock. Ours is the whole gather: cosines, culling, set-up of rays, visibility, and shading. Embree's
/// counts only the time inside its calls, with rays laid out beforehand, and is that of the best mode.
struct GatherBenchResult {
    std::size_t triangles = 0;
    BvhQuality bvh = BvhQuality::fast;  ///< of our tree; the caller knows
    std::uint64_t pairs = 0;
    std::uint64_t rays = 0;
    double occluded_fraction = 0.0;
    std::uint64_t disagreements = 0;  ///< rays about which we and Embree differ
    double nearlight_mrays = 0.0;
    double embree1_mrays = 0.0;
    double embree16_mrays = 0.0;
    double ratio_embree1 = 0.0;  ///< median of the ratios of each repeat
    double ratio_embree16 = 0.0;
    double ratio_embree16_deviation = 0.0;  ///< median absolute deviation of that
    std::string embree1_mode;
    std::string embree16_mode;
    std::string device;
};

/// Every repeat runs us and Embree one after the other, so that whatever else the machine does meets all.
GatherBenchResult bench_gather(Device& device, const Scene& scene, const Bvh& bvh,
                               const GatherBenchConfig& config = {});

}  // namespace nearlight
