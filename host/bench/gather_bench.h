// SPDX-License-Identifier: Apache-2.0
// Replays one set of segments through every tracer: our kernels and Embree in all its modes.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "host/bench/agreement.h"
#include "host/bench/gather_segments.h"
#include "host/bench/statistics.h"
#include "host/bvh/bvh.h"
#include "host/cl/device.h"
#include "host/stages/gatherer.h"

namespace nearlight::core {

struct GatherBenchConfig {
    int repeats = 11;
    int threads = 0;  ///< Embree's; 0: as many as there are cores
    /// Ours that take part; `automatic`: both.
    GatherKernel kernel = GatherKernel::automatic;
    float roulette = 0.0f;  ///< threshold; above 0 our kernels take part with Russian roulette too
};

/// One tracer. Rates follow from `median`: ours is the whole gather (cosines, culling, set-up of rays,
/// visibility, shading), Embree's only the time inside its calls, with rays laid out beforehand.
struct TracerFigures {
    std::string name;
    int embree_width = 0;       ///< rays a call: 1 or 16; 0: ours
    bool has_roulette = false;  ///< resolves all pairs with fewer rays
    Seconds median{};           ///< over the repeats
    std::uint64_t rays = 0;
    std::uint64_t occluded = 0;
    std::uint64_t disagreements = 0;  ///< rays about which it and rtcOccluded1 (incoherent, medium) differ
    /// It differs for 10⁻⁵ of the rays or more. A mode of Embree that does is not among those that count.
    bool is_wrong = false;
};

/// The fastest, by the wall clock, of the tracers with so many rays a call that are not wrong; of the wrong
/// ones where there is no other. There must be one of that kind, or the number of tracers is returned.
std::size_t fastest_tracer(std::span<const TracerFigures> tracers, int embree_width,
                           bool has_roulette = false);

struct GatherBenchResult {
    std::size_t triangles = 0;
    std::string device;
    std::uint64_t pairs = 0;  ///< of a receiver and a VPL
    std::uint64_t after_culling = 0;
    std::vector<TracerFigures> tracers;
    std::size_t ours = 0, embree1 = 0, embree16 = 0;  ///< the fastest of each kind, in `tracers`
    std::optional<std::size_t> roulette;              ///< the fastest with roulette, if there is one
    Ratio wall1, wall16;                      ///< the fastest of Embree's modes ÷ the fastest of ours
    Ratio processor1, processor16;            ///< the same in processor time; only where the device is a CPU
    Ratio wall_roulette, processor_roulette;  ///< the fastest with 16 rays a call ÷ the fastest with roulette

    double edge_tolerance = 0.0;  ///< see Agreement
    std::vector<Disagreement> disagreements;
    bool agrees = false;  ///< ours, with Embree: rarely wrong, each time excusably
};

/// Every repeat runs all tracers one after the other, so that whatever else the machine does meets all.
GatherBenchResult bench_gather(Device& device, const GatherSegments& segments, const Bvh& bvh,
                               const GatherBenchConfig& config = {});

}  // namespace nearlight::core
