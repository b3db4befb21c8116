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
    int threads = 0;  ///< threads of Embree; 0: one per core
    /// The kernel of ours that takes part; `automatic`: both.
    GatherKernel kernel = GatherKernel::automatic;
    float roulette = 0.0f;  ///< threshold; if above 0, our kernels also take part with Russian roulette
};

/// The figures of one tracer. Rates follow from `median`: for our kernels that is the time of the whole
/// gather (cosines, culling, set-up of rays, visibility, shading), for Embree only the time inside its calls,
/// with rays laid out beforehand.
struct TracerFigures {
    std::string name;
    int embree_width = 0;       ///< rays per call of Embree: 1 or 16; 0: one of our kernels
    bool has_roulette = false;  ///< covers all pairs with fewer rays, by Russian roulette
    Seconds median{};           ///< over the repeats
    std::uint64_t rays = 0;
    std::uint64_t occluded = 0;
    std::uint64_t disagreements = 0;  ///< rays about which it differs from rtcOccluded1 (incoherent, medium)
    /// Whether it differs for 10⁻⁵ of the rays or more. Such a mode of Embree is not compared with.
    bool is_wrong = false;
};

/// Index of the tracer that is fastest by the wall clock among those with `embree_width` and `has_roulette`.
/// A tracer that is wrong is chosen only where all are. Returns the number of tracers if there is none of
/// that kind.
std::size_t fastest_tracer(std::span<const TracerFigures> tracers, int embree_width,
                           bool has_roulette = false);

struct GatherBenchResult {
    std::size_t triangles = 0;
    std::string device;
    std::uint64_t pairs = 0;          ///< pairs of a present receiver and a VPL
    std::uint64_t after_culling = 0;  ///< pairs that are left after culling
    std::vector<TracerFigures> tracers;
    std::size_t ours = 0, embree1 = 0, embree16 = 0;  ///< indices of the fastest of each kind in `tracers`
    std::optional<std::size_t> roulette;              ///< index of the fastest with roulette; empty: none ran
    Ratio wall1, wall16;            ///< the fastest of Embree's modes ÷ the fastest of ours
    Ratio processor1, processor16;  ///< as wall1 and wall16 in processor time; only where the device is a CPU
    Ratio wall_roulette,
        processor_roulette;  ///< the fastest with 16 rays per call ÷ the fastest with roulette

    double edge_tolerance = 0.0;  ///< Agreement::edge_tolerance(), m
    std::vector<Disagreement> disagreements;
    bool agrees = false;  ///< our kernels differ from Embree rarely, and each time excusably
};

/// Measures all tracers. Every repeat runs them one after the other, so that other load on the machine
/// affects all alike.
GatherBenchResult bench_gather(Device& device, const GatherSegments& segments, const Bvh& bvh,
                               const GatherBenchConfig& config = {});

}  // namespace nearlight::core
