// SPDX-License-Identifier: Apache-2.0
// One number for the noise of a picture, from the variances of its pixels.
#pragma once

#include <span>
#include <vector>

#include "kernels/shared/types.h"

namespace nearlight::core {

/// What the variance of each channel of each pixel is compared with: b² + m²/100, where b is the mean of the
/// channel over the pixel's tile and m the mean of all channels of the picture. The mean is that of a tile,
/// because a pixel that is too bright by chance would otherwise hide its own error. `beauty` holds R, G and B
/// of each pixel, row by row.
std::vector<float> error_norms(std::span<const float> beauty, uint width);

/// The root of the mean of variance ÷ norm over all channels and pixels but the thousandth with the largest
/// quotients: a few pixels that a rare path has hit say little about a picture. A variance of 0 counts as 0
/// whatever its norm, so the error of a black picture is 0.
double relative_error(std::span<const float> variances, std::span<const float> norms);

}  // namespace nearlight::core
