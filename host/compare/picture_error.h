// SPDX-License-Identifier: Apache-2.0
// The errors of the indirect light of a picture against the reference.
#pragma once

#include <array>
#include <cstddef>

#include "host/compare/reference.h"
#include "host/compare/settings.h"
#include "host/image/image.h"

namespace nearlight::core {

/// The errors of a picture. The reference's own noise, which is independent of the picture's, adds its
/// variance to every squared error. Where that variance is known, its mean is subtracted. In expectation
/// `squared_error` and `relative_mse` are then those against a reference without noise; they may be negative
/// if there is hardly any error.
struct PictureError {
    double squared_error = 0;  ///< mean over pixels and R, G, B; the paper's RMSE is its root
    double relative_mse = 0;   ///< mean of (a − b)² / (b² + 0.01), b the reference
    /// Mean luminance ÷ the reference's mean luminance, which shows light lost or gained.
    double mean_ratio = 0;
    std::array<double, 3> mean_error{};  ///< mean of a − b for R, G and B
    double flip = 0;             ///< mean FLIP error of the pictures multiplied by Reference::display_scale
    std::size_t non_finite = 0;  ///< number of pixels with NaN or infinity, which are left out
};

PictureError picture_error(const Image& picture, const Reference& reference);

/// The paper's RMSE in a part of the picture. The noise of the reference is not subtracted.
double rmse_of_part(const Image& picture, const Image& reference, const Crop& part);

}  // namespace nearlight::core
