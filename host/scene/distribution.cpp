// SPDX-License-Identifier: Apache-2.0
#include "host/scene/distribution.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "nearlight/error.h"

namespace nearlight::core {
namespace {

constexpr double kQuanta = 0x1p24;

}  // namespace

std::vector<float> cumulative_distribution(std::span<const double> weights) {
    double total = 0;
    std::size_t positive = 0;
    for (const double weight : weights) {
        if (weight > 0) {
            total += weight;
            ++positive;
        }
    }
    const bool uniform = positive == 0;
    if (uniform) {
        total = static_cast<double>(weights.size());
        positive = weights.size();
    }
    if (static_cast<double>(positive) > kQuanta / 2) {
        throw Error(ErrorKind::out_of_memory, "there are " + std::to_string(positive) +
                                                  " sources of light to choose from, and only " +
                                                  std::to_string(static_cast<std::size_t>(kQuanta / 2)) +
                                                  " can be told apart; emit light from fewer triangles");
    }
    // Each positive weight gets one quantum, and the rest is shared in proportion.
    const double shared = kQuanta - static_cast<double>(positive);
    std::vector<float> cdf;
    cdf.reserve(weights.size());
    double sum = 0;
    double seen = 0;
    for (const double weight : weights) {
        if (uniform || weight > 0) {
            sum += uniform ? 1.0 : weight;
            seen += 1;
        }
        // sum repeats the additions of total, so that it ends at the same bits and the ratio at exactly 1.
        cdf.push_back(static_cast<float>((std::floor(sum / total * shared) + seen) / kQuanta));
    }
    return cdf;
}

std::size_t select(std::span<const float> cdf, float u) {
    return static_cast<std::size_t>(std::upper_bound(cdf.begin(), cdf.end(), u) - cdf.begin());
}

}  // namespace nearlight::core
