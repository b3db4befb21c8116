// SPDX-License-Identifier: Apache-2.0
// The reference: a path tracer that computes exactly what docs/method.md defines, and shares no code with the
// kernels.
#pragma once

#include <cstdint>
#include <functional>

#include "host/image/image.h"
#include "host/reference/embree_scene.h"
#include "host/scene/scene.h"

namespace nearlight::core {

struct PathTracerSettings {
    int width = 0;   ///< pixels; 0: the camera's
    int height = 0;  ///< pixels; 0: the camera's, or in proportion to the width where only that is given
    int spp = 64;    ///< samples per pixel, rounded up to whole batches
    /// 1: emission, 2: direct light too, 3: one bounce, …; −1 or 0: no limit. Every surface counts, glass
    /// too.
    int max_depth = 0;
    /// R of the bounded geometry term, m; 0: unbounded. Above 0, light that other surfaces send to receivers
    /// other than diffusely is left out (see PathIntegrator).
    float clamp_radius = 0.0f;
    bool indirect_only = false;  ///< beauty is the indirect light alone
    bool pixel_centers = false;  ///< all samples go through pixels' centres, as the renderer's do at 1 spp
    int batch_size = 0;  ///< 1, 4 or 16 samples that are stratified together; 0: samples_per_batch(spp)
    std::uint64_t seed = 0;
    int threads = 0;  ///< 0: one per core. The picture does not depend on it.
};

/// The batch size for `spp` samples per pixel: 1 below 32, 4 below 256, otherwise 16. The variance is
/// estimated from the means of batches, so from 8 spp on there are at least eight.
int samples_per_batch(int spp);

/// The settings with everything filled in: size, batch size, and spp in whole batches. Throws
/// Error(ErrorKind::invalid_argument) for values out of range.
PathTracerSettings completed(PathTracerSettings settings, const SceneCamera& camera);

/// Receives the fraction of the work that is done, from one thread at a time. It returns false to stop.
using Progress = std::function<bool(double fraction)>;

/// How a picture that takes hours is continued and saved.
struct LongTrace {
    /// A picture to continue: trace_paths() made it of the same scene with the same settings, perhaps with
    /// fewer samples per pixel. The settings must name its batch_size. Null: a new picture.
    const Image* earlier = nullptr;
    std::function<void(const Image&)> save{};  ///< receives the unfinished picture at intervals; may be empty
    double seconds_between_saves = 180;
};

/// Renders the picture with the channels R, G, B (beauty: direct + indirect), direct.* and indirect.* (as in
/// PathLight), albedo.* (of the receiver, seen by way of mirrors, coats and glass), N.X… and P.X… (of the
/// receiver, world space), depth.Z (to the first surface, m; mean over the samples that met one), variance.*
/// (of the mean of beauty), indirectVariance.*, and count.X, count.Y and count.Z: the numbers of samples, of
/// samples that found a receiver, and of samples that found a surface, which a continuation needs. A variance
/// is infinite where a pixel has fewer than two batches. If the rendering is stopped, each pixel has the mean
/// of its finished samples. Throws what completed() throws, Error(ErrorKind::file) if `earlier` cannot be
/// continued, and Embree's errors.
Image trace_paths(const Scene& scene, const PathTracerSettings& settings, const Progress& progress = {},
                  const LongTrace& long_trace = {});

}  // namespace nearlight::core
