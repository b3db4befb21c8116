// SPDX-License-Identifier: Apache-2.0
// What kernels/camera_lights.cl must compute, in double precision.
#pragma once

#include <span>

#include "host/reference/film_oracle.h"
#include "kernels/shared/camera_pass.h"

namespace nearlight::core {

/// The light that the camera paths of a pixel bring on their own, over the first `half_end` samples and the
/// others.
CameraLight expected_camera_light(const FilmSamples& samples, const FilmLayout& layout, uint half_end, uint x,
                                  uint y);

/// How many rounds pixel (x, y) gets, of a band that is `width` pixels wide. `lights` and `sums` are those of
/// all of its pixels, which have `sample_count` samples.
uint expected_rounds(std::span<const CameraLight> lights, std::span<const float> sums, uint width,
                     uint sample_count, uint x, uint y);

}  // namespace nearlight::core
