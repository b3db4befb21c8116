// SPDX-License-Identifier: Apache-2.0
#include "host/session/relative_error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

namespace nearlight::core {
namespace {

constexpr std::size_t kErrorChannels = 3;
/// The part of m² in the norm, so that dark corners do not decide the error of the picture.
constexpr double kDarkShare = 0.01;
/// One pixel in so many is left out.
constexpr std::size_t kPixelsPerOutlier = 1000;

}  // namespace

std::vector<float> error_norms(std::span<const float> beauty, uint width) {
    constexpr std::size_t kTile = NEARLIGHT_TILE_SIZE;
    const std::size_t row_size = kErrorChannels * width;
    const std::size_t height = beauty.size() / std::max<std::size_t>(row_size, 1);
    const double mean = std::accumulate(beauty.begin(), beauty.end(), 0.0) /
                        static_cast<double>(std::max<std::size_t>(beauty.size(), 1));
    std::vector<float> norms(beauty.size());
    for (std::size_t top = 0; top < height; top += kTile) {
        const std::size_t bottom = std::min(top + kTile, height);
        for (std::size_t left = 0; left < row_size; left += kTile * kErrorChannels) {
            const std::size_t right = std::min(left + kTile * kErrorChannels, row_size);
            std::array<double, kErrorChannels> sums{};
            for (std::size_t y = top; y < bottom; ++y) {
                for (std::size_t x = left; x < right; ++x) {
                    sums[x % kErrorChannels] += double{beauty[y * row_size + x]};
                }
            }
            const auto pixels = static_cast<double>((bottom - top) * (right - left) / kErrorChannels);
            for (std::size_t y = top; y < bottom; ++y) {
                for (std::size_t x = left; x < right; ++x) {
                    const double local = sums[x % kErrorChannels] / pixels;
                    norms[y * row_size + x] = static_cast<float>(local * local + kDarkShare * mean * mean);
                }
            }
        }
    }
    return norms;
}

double relative_error(std::span<const float> variances, std::span<const float> norms) {
    std::vector<double> quotients(variances.size() / kErrorChannels);
    for (std::size_t i = 0; i < quotients.size() * kErrorChannels; ++i) {
        if (variances[i] > 0.0f) {
            constexpr float kLeast = std::numeric_limits<float>::denorm_min();
            quotients[i / kErrorChannels] += double{variances[i]} / double{std::max(norms[i], kLeast)};
        }
    }
    const std::size_t kept = quotients.size() - quotients.size() / kPixelsPerOutlier;
    if (kept == 0) {
        return 0.0;
    }
    const auto end = quotients.begin() + static_cast<std::ptrdiff_t>(kept);
    std::nth_element(quotients.begin(), end - 1, quotients.end());
    return std::sqrt(std::accumulate(quotients.begin(), end, 0.0) /
                     static_cast<double>(kept * kErrorChannels));
}

}  // namespace nearlight::core
