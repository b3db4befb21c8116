// SPDX-License-Identifier: Apache-2.0
// Measures the traversal of camera pass and light tracer beside Embree's, on the same rays.
#pragma once

#include <string>
#include <vector>

#include "host/bench/seconds.h"
#include "host/cl/device.h"
#include "host/scene/scene.h"

namespace nearlight::core {

struct TraceBenchConfig {
    int width = 512;  ///< camera rays: one for each pixel
    int height = 512;
    std::size_t walk_rays = 1u << 18u;  ///< of light walks
    int repeats = 11;
    int threads = 0;  ///< that ask Embree; 0: as many as there are cores
};

struct RayTracerFigures {
    std::string name;
    Seconds median{};
    /// Rays that it lets pass and rtcIntersect1 does not, or the other way round, or whose hits lie apart.
    std::size_t differing = 0;
};

/// Rays of one kind. Ratios are the seconds of the fastest of Embree's modes over ours: by wall clock, and by
/// processor time where the device is a CPU (otherwise 0).
struct RaySetResult {
    std::string name;  ///< "camera", "light walks"
    std::size_t rays = 0;
    std::size_t hits = 0;
    std::vector<RayTracerFigures> tracers;  ///< ours first
    std::string best;                       ///< of Embree's modes
    double ratio = 0.0;
    double ratio_processor = 0.0;
    bool agrees = true;  ///< ours differs for less than 1e-5 of the rays (one is let pass)
};

struct TraceBenchResult {
    std::string device;
    std::size_t triangles = 0;
    std::vector<RaySetResult> sets;
};

/// Closest hits of what the camera's pixels send out, in tiles, and of light walks, one after the other: the
/// kernel of ray_caster.cl, whose traversal the other kernels share, and all of Embree's modes in turn.
TraceBenchResult bench_trace(Device& device, const Scene& scene, const TraceBenchConfig& config = {});

}  // namespace nearlight::core
