// SPDX-License-Identifier: Apache-2.0
#include "host/compare/picture_error.h"

#include <algorithm>
#include <cmath>

#include "host/base/math.h"
#include "host/compare/pictures.h"
#include "host/image/flip.h"

namespace nearlight::core {
namespace {

double mean_flip(const Image& picture, const Reference& reference) {
    std::vector<Vec3> a = pixels_of(scaled(picture, reference.display_scale));
    const std::vector<Vec3> b = pixels_of(scaled(reference.picture, reference.display_scale));
    for (Vec3& pixel : a) {
        pixel = is_finite(pixel) ? pixel : Vec3{0, 0, 0};
    }
    const std::vector<float> errors = flip_error(picture.width, picture.height, a, b);
    double sum = 0.0;
    for (const float error : errors) {
        sum += static_cast<double>(error);
    }
    return sum / static_cast<double>(errors.size());
}

}  // namespace

PictureError picture_error(const Image& picture, const Reference& reference) {
    PictureError result;
    double picture_light = 0.0;
    double reference_light = 0.0;
    double pixels = 0.0;
    for (std::size_t i = 0; i < picture.values.size(); i += 3) {
        const float* const a = &picture.values[i];
        const float* const b = &reference.picture.values[i];
        if (!is_finite(Vec3{a[0], a[1], a[2]})) {
            ++result.non_finite;
            continue;
        }
        for (std::size_t c = 0; c < 3; ++c) {
            const double truth = static_cast<double>(b[c]);
            const double error = static_cast<double>(a[c]) - truth;
            result.squared_error += error * error;
            result.relative_mse += error * error / (truth * truth + kRelativeErrorFloor);
            result.mean_error[c] += error;
        }
        picture_light += static_cast<double>(luminance({a[0], a[1], a[2]}));
        reference_light += static_cast<double>(luminance({b[0], b[1], b[2]}));
        pixels += 1.0;
    }
    pixels = std::max(pixels, 1.0);
    result.squared_error = result.squared_error / (3.0 * pixels) - reference.noise.mean_variance;
    result.relative_mse = result.relative_mse / (3.0 * pixels) - reference.noise.mean_relative_variance;
    for (double& error : result.mean_error) {
        error /= pixels;
    }
    result.mean_ratio = picture_light / reference_light;
    result.flip = mean_flip(picture, reference);
    return result;
}

double rmse_of_part(const Image& picture, const Image& reference, const Crop& part) {
    const Image a = cropped(picture, part);
    const Image b = cropped(reference, part);
    double squares = 0.0;
    for (std::size_t i = 0; i < a.values.size(); ++i) {
        const double error = static_cast<double>(a.values[i]) - static_cast<double>(b.values[i]);
        squares += error * error;
    }
    return std::sqrt(squares / static_cast<double>(a.values.size()));
}

}  // namespace nearlight::core
