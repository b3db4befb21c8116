// SPDX-License-Identifier: Apache-2.0
#include "host/session/passes.h"

#include <algorithm>
#include <cstdint>
#include <limits>

#include "host/stages/film_layers.h"

namespace nearlight::core {

uint pass_seed(uint seed, uint pass) {
    // This is SplitMix64 [Steele, Lea and Flood, Fast Splittable Pseudorandom Number Generators, 2014].
    std::uint64_t z = ((std::uint64_t{seed} << 32u) | pass) + 0x9e3779b97f4a7c15ull;
    z = (z ^ (z >> 30u)) * 0xbf58476d1ce4e5b9ull;
    z = (z ^ (z >> 27u)) * 0x94d049bb133111ebull;
    return pass == 0 ? seed : static_cast<uint>((z ^ (z >> 31u)) >> 32u);
}

PassClock::PassClock(const RenderSettings& settings, double seconds)
    : passes_(settings.passes.value_or(std::numeric_limits<uint>::max())),
      seconds_(settings.seconds),
      seconds_before_(seconds) {}

bool PassClock::has_another() {
    ++done_;
    const double used = watch_.seconds();
    return done_ < passes_ && (!seconds_ || seconds_before_ + used + used / done_ <= *seconds_);
}

double PassClock::fraction(double of_pass) const {
    const double by_passes = (done_ + of_pass) / passes_;
    const double by_time = seconds_ ? (seconds_before_ + watch_.seconds()) / *seconds_ : 0.0;
    return std::min(1.0, std::max(by_passes, by_time));
}

PassAverage::PassAverage(uint width, uint height)
    : row_size_(std::size_t{width} * NEARLIGHT_LAYER_CHANNELS),
      sums_(row_size_ * height),
      row_passes_(height) {}

void PassAverage::add_rows(std::span<const float> rows) {
    const auto rules = pass_rules();
    for (const std::size_t end = end_ + rows.size(); end_ < end; end_ += row_size_) {
        const std::span<const float> row = rows.last(end - end_).first(row_size_);
        const std::span<float> sums = std::span(sums_).subspan(end_, row_size_);
        const bool is_first = row_passes_[end_ / row_size_]++ == 0;
        for (std::size_t i = 0; i < row_size_; ++i) {
            if (is_first) {
                sums[i] = row[i];
            } else if (rules[i % rules.size()] == PassRule::mean) {
                sums[i] += row[i];
            }
        }
    }
}

void PassAverage::send(const std::function<void(std::span<const float> rows)>& sink) const {
    const auto rules = pass_rules();
    std::vector<float> row(row_size_);
    for (std::size_t y = 0; y < row_passes_.size() && row_passes_[y] > 0; ++y) {
        const std::span<const float> sums = std::span(sums_).subspan(y * row_size_, row_size_);
        const float scale = 1.0f / static_cast<float>(row_passes_[y]);
        for (std::size_t i = 0; i < row_size_; ++i) {
            row[i] = rules[i % rules.size()] == PassRule::mean ? sums[i] * scale : sums[i];
        }
        sink(row);
    }
}

}  // namespace nearlight::core
