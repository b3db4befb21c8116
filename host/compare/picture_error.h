// SPDX-License-Identifier: Apache-2.0
// How far the indirect light of one picture is from the reference.
#pragma once

#include <array>
#include <cstddef>

#include "host/compare/reference.h"
#include "host/compare/settings.h"
#include "host/image/image.h"

namespace nearlight::core {

/// The reference has noise of its own, independent of the picture's, which adds its variance to every squared
/// error. Where it is known, its mean is subtracted, so that `squared_error` and `relative_mse` are those
/// against a reference without noise, in expectation; they may come out negative where there is hardly any
/// error.
struct PictureError {
    double squared_error = 0;            ///< mean over pixels and R, G, B; the paper's RMSE is its root
    double relative_mse = 0;             ///< mean of (a − b)² / (b² + 0.01), b the reference
    double mean_ratio = 0;               ///< mean luminance ÷ that of the reference: light lost or gained
    std::array<double, 3> mean_error{};  ///< mean of a − b for R, G and B
    double flip = 0;             ///< mean FLIP of both as they are looked at (Reference::display_scale)
    std::size_t non_finite = 0;  ///< pixels with NaN or infinity; left out
};

PictureError picture_error(const Image& picture, const Reference& reference);

/// The paper's RMSE of a part of the picture, the noise of the reference not subtracted.
double rmse_of_part(const Image& picture, const Image& reference, const Crop& part);

}  // namespace nearlight::core
