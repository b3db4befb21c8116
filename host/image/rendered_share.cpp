// SPDX-License-Identifier: Apache-2.0
#include "host/image/rendered_share.h"

#include <algorithm>
#include <cstddef>

namespace nearlight::core {
namespace {

/// Windows have (2·kWindowRadius + 1)² pixels.
constexpr std::size_t kWindowRadius = 3;
/// The variance counts so many times, because its estimate misses noise that is rare: what a denoiser changed
/// by less may well have been noise (bench/log/denoise.md).
constexpr double kNoiseFactor = 1.5;
/// Errors are relative to the light of the pixel, with this part of the mean square, so that the dark and the
/// bright side of an edge count alike.
constexpr double kMeanPart = 0.01;

/// One number for each pixel.
using PixelNumbers = std::vector<double>;

double sum_of_squares(std::span<const float> rgb) {
    double sum = 0.0;
    for (const float value : rgb) {
        sum += double{value} * double{value};
    }
    return sum;
}

/// What is divided by the square of each pixel's light.
PixelNumbers relative(PixelNumbers values, const DenoisedPair& pair) {
    const auto count = static_cast<double>(values.size());
    const double part = kMeanPart * sum_of_squares(pair.denoised) / count + 1e-30;
    for (std::size_t i = 0; i < values.size(); ++i) {
        values[i] /= sum_of_squares(pair.denoised.subspan(3 * i, 3)) + part;
    }
    return values;
}

/// The squares of what the denoiser changed, summed over the channels.
PixelNumbers changes(const DenoisedPair& pair) {
    PixelNumbers result(pair.rendered.size() / 3);
    for (std::size_t i = 0; i < pair.rendered.size(); ++i) {
        const double change = double{pair.rendered[i]} - double{pair.denoised[i]};
        result[i / 3] += change * change;
    }
    return result;
}

PixelNumbers variances(const DenoisedPair& pair) {
    PixelNumbers result(pair.variance.size() / 3);
    for (std::size_t i = 0; i < pair.variance.size(); ++i) {
        result[i / 3] += double{pair.variance[i]};
    }
    return result;
}

/// Sums over neighbours at most kWindowRadius steps away, along lines of `length` values that lie `stride`
/// apart. The ends of lines have fewer neighbours.
PixelNumbers sums_along_lines(const PixelNumbers& values, std::size_t length, std::size_t stride) {
    PixelNumbers sums(values.size());
    for (std::size_t i = 0; i < values.size(); ++i) {
        const std::size_t place = i / stride % length;
        const std::size_t before = std::min(place, kWindowRadius);
        const std::size_t after = std::min(length - 1 - place, kWindowRadius);
        for (std::size_t k = i - before * stride; k <= i + after * stride; k += stride) {
            sums[i] += values[k];
        }
    }
    return sums;
}

PixelNumbers window_sums(const PixelNumbers& values, const DenoisedPair& pair) {
    const auto width = static_cast<std::size_t>(pair.width);
    const auto height = static_cast<std::size_t>(pair.height);
    return sums_along_lines(sums_along_lines(values, width, 1), height, width);
}

}  // namespace

std::vector<float> rendered_shares(const DenoisedPair& pair) {
    const PixelNumbers change = window_sums(relative(changes(pair), pair), pair);
    const PixelNumbers noise = window_sums(relative(variances(pair), pair), pair);
    std::vector<float> shares(change.size());
    for (std::size_t i = 0; i < shares.size(); ++i) {
        if (change[i] > kNoiseFactor * noise[i]) {
            shares[i] = static_cast<float>(1.0 - kNoiseFactor * noise[i] / change[i]);
        }
    }
    return shares;
}

}  // namespace nearlight::core
