// SPDX-License-Identifier: Apache-2.0
// The sums that the reference path tracer keeps for each pixel while it renders.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "host/image/image.h"
#include "host/reference/camera_path.h"

namespace nearlight::core {

/// A sum of colours or vectors in double precision.
struct VectorSum {
    double x = 0, y = 0, z = 0;
    void add(Vec3 v) {
        x += v.x;
        y += v.y;
        z += v.z;
    }
    void add(const VectorSum& v) {
        x += v.x;
        y += v.y;
        z += v.z;
    }
};

/// Sums over the samples of one batch.
struct BatchSum {
    VectorSum direct, indirect, albedo, normal, position;
    double depth = 0;
    int receivers = 0;
    int surfaces = 0;  ///< number of samples that met a surface

    void add(Vec3 direct_light, Vec3 indirect_light, const CameraPath& path);
};

/// Sums over the batches of a pixel, and sums of the squares of the batches' means.
struct PixelStatistics {
    BatchSum sum;
    VectorSum beauty_square, indirect_square;
    int samples = 0;
    int batches = 0;

    void add(const BatchSum& batch, int batch_size);
};

/// The picture with the channels that trace_paths() lists. All batches of a pixel have the same size.
Image to_image(std::span<const PixelStatistics> pixels, int width, int height);
/// The inverse of to_image(), except for rounding to float. Throws Error(ErrorKind::file) if a channel is
/// missing or counts contradict each other.
std::vector<PixelStatistics> from_image(const Image& image, int batch_size);

}  // namespace nearlight::core
