// SPDX-License-Identifier: Apache-2.0
// Measures our traversal, as the camera pass and the light tracer use it, and Embree's on the same rays.
#pragma once

#include <string>
#include <vector>

#include "host/bench/seconds.h"
#include "host/cl/device.h"
#include "host/scene/scene.h"

namespace nearlight::core {

struct TraceBenchConfig {
    int width = 512;  ///< of the picture, which has one camera ray per pixel
    int height = 512;
    std::size_t walk_rays = 1u << 18u;  ///< number of rays of walks
    int repeats = 11;
    int threads = 0;  ///< threads of Embree; 0: one per core
};

struct RayTracerFigures {
    std::string name;
    Seconds median{};
    /// Number of rays that hit something according to only one of this tracer and rtcIntersect1, or that hit
    /// at different distances.
    std::size_t differing = 0;
};

/// The figures for rays of one kind. Ratios are the seconds of Embree's fastest mode divided by ours, where
/// only modes count that differ for at most 1e-5 of the rays, or for one ray: by the wall clock, and by
/// processor time where the device is a CPU (otherwise 0).
struct RaySetResult {
    std::string name;  ///< "camera", "light walks"
    std::size_t rays = 0;
    std::size_t hits = 0;
    std::vector<RayTracerFigures> tracers;  ///< our kernel first
    std::string best;                       ///< name of Embree's fastest mode, of those that count
    double ratio = 0.0;
    double ratio_processor = 0.0;
    bool agrees = true;  ///< our kernel differs for at most 1e-5 of the rays, or for one ray
};

struct TraceBenchResult {
    std::string device;
    std::size_t triangles = 0;
    std::vector<RaySetResult> sets;
};

/// Measures closest hits, first of camera rays in tiles, then of the rays of walks. The kernel of
/// ray_caster.cl, whose traversal the other kernels share, and all of Embree's modes run in turn.
TraceBenchResult bench_trace(Device& device, const Scene& scene, const TraceBenchConfig& config = {});

}  // namespace nearlight::core
