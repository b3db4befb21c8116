// SPDX-License-Identifier: Apache-2.0
#include "host/session/pass_sums.h"

#include <algorithm>
#include <array>
#include <functional>

namespace nearlight::core {
namespace {

/// What becomes of a channel, and its place among the channels that share this rule.
struct ChannelPlace {
    PassRule rule = PassRule::mean;
    std::size_t index = 0;
};

constexpr std::array<ChannelPlace, NEARLIGHT_LAYER_CHANNELS> make_places() {
    std::array<ChannelPlace, NEARLIGHT_LAYER_CHANNELS> places{};
    std::array<std::size_t, 3> counts{};
    constexpr std::array kRules = pass_rules();
    for (std::size_t channel = 0; channel < kRules.size(); ++channel) {
        places[channel] = {kRules[channel], counts[static_cast<std::size_t>(kRules[channel])]++};
    }
    return places;
}

constexpr std::array kPlaces = make_places();
constexpr std::size_t kFirstVariance = PassSums::kMeans;
constexpr std::size_t kFirstSquare = kFirstVariance + PassSums::kVariances;

}  // namespace

PassSums::PassSums(std::size_t width, std::size_t height)
    : width_(width), sums_(width * height * kSums), firsts_(width * height * kFirsts), rows_(height) {}

void PassSums::add_row(std::size_t y, std::span<const float> values, std::uint32_t samples) {
    const double weight = samples;
    const double square = weight * weight;
    const bool is_first = rows_[y].passes == 0;
    for (std::size_t x = 0; x < width_; ++x) {
        const std::span<const float> pixel = values.subspan(x * kPlaces.size(), kPlaces.size());
        const std::span<DoubleSum> sums = std::span(sums_).subspan((y * width_ + x) * kSums, kSums);
        const std::span<float> firsts = std::span(firsts_).subspan((y * width_ + x) * kFirsts, kFirsts);
        for (std::size_t channel = 0; channel < kPlaces.size(); ++channel) {
            const auto [rule, index] = kPlaces[channel];
            const double value = pixel[channel];
            if (rule == PassRule::mean) {
                // A float times a number of samples fits into a double.
                sums[index] = sums[index] + DoubleSum{value * weight, 0.0};
            } else if (rule == PassRule::variance) {
                DoubleSum& own = sums[kFirstVariance + index];
                own = own + exact_product(value, square);
            } else if (is_first) {
                firsts[index] = pixel[channel];
            }
        }
        for (std::size_t color = 0; color < kVariances; ++color) {
            const double value = pixel[NEARLIGHT_LAYER_BEAUTY + color];
            sums[kFirstSquare + color] = sums[kFirstSquare + color] + exact_product(value * weight, value);
        }
    }
    rows_[y].passes += 1;
    rows_[y].samples += samples;
}

void PassSums::add(const PassSums& other) {
    std::ranges::transform(sums_, other.sums_, sums_.begin(), std::plus());
    for (std::size_t y = 0; y < rows_.size(); ++y) {
        if (rows_[y].passes == 0) {
            const std::size_t first = y * width_ * kFirsts;
            std::copy_n(other.firsts_.begin() + static_cast<std::ptrdiff_t>(first), width_ * kFirsts,
                        firsts_.begin() + static_cast<std::ptrdiff_t>(first));
        }
        rows_[y].passes += other.rows_[y].passes;
        rows_[y].samples += other.rows_[y].samples;
    }
}

float PassSums::value(std::size_t x, std::size_t y, std::size_t channel) const {
    const auto [rule, index] = kPlaces[channel];
    const auto samples = static_cast<double>(rows_[y].samples);
    switch (rule) {
        case PassRule::mean:
            return static_cast<float>(sum(x, y, index).value() / samples);
        case PassRule::variance:
            return static_cast<float>(sum(x, y, kFirstVariance + index).value() / (samples * samples));
        case PassRule::first:
            break;
    }
    return firsts_[(y * width_ + x) * kFirsts + index];
}

/// With weights w and W = Σw, the weighted sum of squares about the mean is Σwv² − (Σwv)² ÷ W. The difference
/// loses no bit that counts, because its terms have 106.
float PassSums::spread_variance(std::size_t x, std::size_t y, std::size_t color) const {
    const Row& row = rows_[y];
    if (row.passes < 2) {
        return 0.0f;
    }
    const auto samples = static_cast<double>(row.samples);
    const DoubleSum& light = sum(x, y, kPlaces[NEARLIGHT_LAYER_BEAUTY + color].index);
    const DoubleSum& squares = sum(x, y, kFirstSquare + color);
    // W · Σwv² − (Σwv)², which needs no division of long numbers. The square of the lower part is beyond the
    // 106 bits.
    const DoubleSum scaled = exact_product(squares.high, samples) + DoubleSum{squares.low * samples, 0.0};
    const DoubleSum square =
        exact_product(light.high, light.high) + exact_product(2.0 * light.high, light.low);
    const double spread = std::max((scaled + -square).value(), 0.0);
    return static_cast<float>(spread / (samples * samples * (row.passes - 1.0)));
}

}  // namespace nearlight::core
