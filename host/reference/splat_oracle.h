// SPDX-License-Identifier: Apache-2.0
// What splats must bring to pixels, in double precision: for every pixel, all samples are asked whether its
// filter reaches them.
#pragma once

#include <span>

#include "host/reference/film_oracle.h"
#include "kernels/shared/splats.h"

namespace nearlight::core {

/// Samples with random numbers in every field, but with weights as the camera pass has them for splats: so
/// those of a pixel do not add up to 0.
FilmSamples random_splat_samples(const FilmLayout& layout);

/// The light of a pixel, radiance.
struct SplattedLight {
    double direct[3] = {};
    double indirect[3] = {};
    double half[3] = {};  ///< direct and indirect, by the first half of the samples alone
    double coverage = 0;  ///< the part of the weights of samples that met a surface
};

/// The light of pixel (x, y) where samples count in all pixels that they reach. `camera` has the filter.
SplattedLight expected_splatted_light(const FilmSamples& samples, const FilmLayout& layout,
                                      const Camera& camera, uint x, uint y);

/// The light of pixel (x, y) that row splats come to: splat_rows(reach) of them for each pixel.
SplattedLight light_of_splats(std::span<const RowSplat> rows, const FilmLayout& layout, uint reach, uint x,
                              uint y);

}  // namespace nearlight::core
