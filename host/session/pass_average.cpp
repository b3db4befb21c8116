// SPDX-License-Identifier: Apache-2.0
#include "host/session/pass_average.h"

#include <algorithm>
#include <utility>

#include "host/base/division.h"
#include "host/session/relative_error.h"
#include "host/stages/film_layers.h"

namespace nearlight::core {
namespace {

constexpr std::size_t kLightChannels = NEARLIGHT_CHANNELS_RGB;
constexpr std::size_t kRowChannels = NEARLIGHT_LAYER_CHANNELS;
/// The factor of the passes' own variances begins at 1, with the weight of this many spreads of two passes.
/// The spread of two passes over a picture is no exact measure, because pixels share the VPLs.
constexpr double kTrustInOwn = 1.0;

}  // namespace

PassAverage::PassAverage(uint width, uint height) : sums_(width, height) {}

PassAverage::PassAverage(PassSums sums, uint begun_samples, std::size_t begun_rows)
    : sums_(std::move(sums)), end_(begun_rows), samples_(begun_samples) {}

void PassAverage::begin_pass(uint samples) {
    end_ = 0;
    samples_ = samples;
}

void PassAverage::add_rows(std::span<const float> rows) {
    const std::size_t row_size = sums_.width() * kRowChannels;
    for (; !rows.empty(); rows = rows.subspan(row_size)) {
        sums_.add_row(end_++, rows.first(row_size), samples_);
    }
}

std::size_t PassAverage::reached_rows() const {
    std::size_t y = 0;
    while (y < sums_.height() && sums_.row(y).passes > 0) {
        ++y;
    }
    return y;
}

/// Calls value(x, y, color) for R, G and B of all pixels in the rows that were reached.
template <typename Value>
std::vector<float> PassAverage::colors(const Value& value) const {
    std::vector<float> result;
    const std::size_t rows = reached_rows();
    result.reserve(rows * sums_.width() * kLightChannels);
    for (std::size_t y = 0; y < rows; ++y) {
        for (std::size_t x = 0; x < sums_.width(); ++x) {
            for (std::size_t color = 0; color < kLightChannels; ++color) {
                result.push_back(value(x, y, color));
            }
        }
    }
    return result;
}

std::vector<float> PassAverage::beauty() const {
    return colors([&](std::size_t x, std::size_t y, std::size_t color) {
        return sums_.value(x, y, NEARLIGHT_LAYER_BEAUTY + color);
    });
}

/// The variance of the mean by the passes' own variances.
std::vector<float> PassAverage::own_variances() const {
    return colors([&](std::size_t x, std::size_t y, std::size_t color) {
        return sums_.value(x, y, NEARLIGHT_LAYER_VARIANCE + color);
    });
}

std::vector<float> PassAverage::spread_variances() const {
    return colors(
        [&](std::size_t x, std::size_t y, std::size_t color) { return sums_.spread_variance(x, y, color); });
}

std::vector<float> PassAverage::variances(std::span<const float> norms) const {
    std::vector<float> own = own_variances();
    const std::vector<float> spread = spread_variances();
    const std::size_t row_size = kLightChannels * sums_.width();
    double known = 0.0;
    double own_sum = 0.0;
    for (std::size_t i = 0; i < own.size(); ++i) {
        const double others = sums_.row(i / row_size).passes - 1.0;
        if (norms[i] > 0.0f) {
            known += (others * double{spread[i]} + kTrustInOwn * double{own[i]}) / double{norms[i]};
            own_sum += (others + kTrustInOwn) * double{own[i]} / double{norms[i]};
        }
    }
    for (std::size_t i = 0; i < own.size(); ++i) {
        const auto passes = static_cast<float>(sums_.row(i / row_size).passes);
        // Passes of one sample have no variance of their own.
        own[i] = own_sum > 0.0
                     ? (static_cast<float>(known / own_sum) * own[i] + (passes - 1.0f) * spread[i]) / passes
                     : spread[i];
    }
    return own;
}

double PassAverage::error() const {
    const std::vector<float> norms = error_norms(beauty(), static_cast<uint>(sums_.width()));
    return relative_error(variances(norms), norms);
}

uint PassAverage::telling_passes() const {
    constexpr std::size_t kTellingPixels = 64;
    constexpr std::size_t kMaxTelling = 8;
    const std::size_t pixels = std::max<std::size_t>(sums_.width() * sums_.height(), 1);
    return static_cast<uint>(
        std::clamp<std::size_t>(divide_rounding_up(kTellingPixels, pixels), 1, kMaxTelling));
}

void PassAverage::send(const std::function<void(std::span<const float> rows)>& sink) const {
    const std::vector<float> variance = variances(error_norms(beauty(), static_cast<uint>(sums_.width())));
    std::vector<float> row(sums_.width() * kRowChannels);
    for (std::size_t y = 0; y < reached_rows(); ++y) {
        for (std::size_t x = 0; x < sums_.width(); ++x) {
            const std::span<float> pixel = std::span(row).subspan(x * kRowChannels, kRowChannels);
            for (std::size_t channel = 0; channel < kRowChannels; ++channel) {
                pixel[channel] = sums_.value(x, y, channel);
            }
            std::copy_n(
                variance.begin() + static_cast<std::ptrdiff_t>((y * sums_.width() + x) * kLightChannels),
                kLightChannels, pixel.begin() + NEARLIGHT_LAYER_VARIANCE);
        }
        sink(row);
    }
}

}  // namespace nearlight::core
