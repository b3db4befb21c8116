// SPDX-License-Identifier: Apache-2.0
// The reference: a path tracer that computes exactly what docs/method.md defines, on its own code.
#pragma once

#include <cstdint>
#include <functional>

#include "host/image/image.h"
#include "host/reference/embree_scene.h"
#include "host/scene/scene.h"

namespace nearlight::core {

struct PathTracerSettings {
    int width = 0;               ///< pixels; 0: the camera's
    int height = 0;              ///< pixels; 0: the camera's, or in proportion where only the width is given
    int spp = 64;                ///< samples per pixel, rounded up to whole batches
    int max_depth = 0;           ///< 1: emission, 2: direct light too, 3: one bounce, …; 0: no limit
    float clamp_radius = 0.0f;   ///< R of the bounded geometry term, m; 0: unbounded
    bool indirect_only = false;  ///< beauty is the indirect light alone
    bool pixel_centers = false;  ///< all samples go through pixels' centres, as the renderer's at 1 spp
    int batch_size = 0;          ///< 1, 4 or 16 samples that are stratified together; 0: as many as suit spp
    std::uint64_t seed = 0;
    int threads = 0;  ///< 0: as many as there are cores. The picture does not depend on it.
};

/// Samples that are stratified together: 1 below 32 samples per pixel, 4 below 256, else 16. The variance is
/// estimated from the means of batches, of which there are therefore at least eight from 8 spp on.
int samples_per_batch(int spp);

/// The settings with nothing left open: size, batch size, spp in whole batches. Throws
/// Error(ErrorKind::invalid_argument) on those that make no sense.
PathTracerSettings completed(PathTracerSettings settings, const SceneCamera& camera);

/// Told the fraction that is done, by one thread at a time; returns false to stop.
using Progress = std::function<bool(double fraction)>;

/// For pictures that take hours.
struct LongTrace {
    /// A picture that trace_paths() made of the same scene with the same settings, but perhaps fewer samples
    /// per pixel; tracing goes on from there. Its batch_size must be named in the settings.
    const Image* earlier = nullptr;
    std::function<void(const Image&)> save{};  ///< gets the picture so far, every now and then
    double seconds_between_saves = 180;
};

/// Channels R, G, B (beauty: direct + indirect), direct.* (with emission), indirect.*, albedo.* (of the
/// receiver, seen through mirrors and glass), N.X… and P.X… (of the receiver, world space), depth.Z (to the
/// first surface, m; mean over the samples that met one), variance.* (of the mean of beauty),
/// indirectVariance.*, and count.X, count.Y and count.Z: samples, those that found a receiver, and those that
/// found a surface, which is all that going on needs besides. A variance is infinite where a pixel has fewer
/// than two batches. A stopped rendering has, in each pixel, the mean of the samples it got. Throws what
/// completed() throws, Error(ErrorKind::file) if `earlier` is not a picture to go on from, and Embree's
/// errors.
Image trace_paths(const Scene& scene, const PathTracerSettings& settings, const Progress& progress = {},
                  const LongTrace& long_trace = {});

}  // namespace nearlight::core
