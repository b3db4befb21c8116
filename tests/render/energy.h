// SPDX-License-Identifier: Apache-2.0
// Power of VPL sets by region and depth over several seeds, and whether two samplers agree on it.
#pragma once

#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "host/base/math.h"

namespace nearlight::test {

/// Inside the close range or not, and depth.
using EnergyClass = std::pair<bool, uint>;
/// Power (luminance, W) of each class, one entry a seed.
using Energies = std::map<EnergyClass, std::vector<double>>;

inline bool in_region(const CloseRange& region, Vec3 p) {
    for (const auto& plane : region.planes) {
        if (plane[0] * p.x + plane[1] * p.y + plane[2] * p.z + plane[3] < 0.0f) {
            return false;
        }
    }
    return length(p - region.origin) < region.range;
}

/// Adds what one seed's set carries, in all classes up to `depths`.
inline void add_energies(Energies& energies, const std::vector<Vpl>& vpls, const CloseRange& region,
                         uint depths) {
    std::map<EnergyClass, double> sums;
    for (uint depth = 1; depth <= depths; ++depth) {
        sums[{false, depth}] = sums[{true, depth}] = 0.0;
    }
    for (const Vpl& vpl : vpls) {
        sums.at({in_region(region, vpl.position), vpl.depth}) += luminance(vpl.power);
    }
    for (const auto& [key, sum] : sums) {
        energies[key].push_back(sum);
    }
}

struct Spread {
    double mean = 0;
    double error = 0;  ///< standard error of the mean
};
inline Spread spread_of(const std::vector<double>& values) {
    const auto n = static_cast<double>(values.size());
    double sum = 0;
    for (const double value : values) {
        sum += value;
    }
    const double mean = sum / n;
    double squares = 0;
    for (const double value : values) {
        squares += (value - mean) * (value - mean);
    }
    return {mean, std::sqrt(squares / (n * (n - 1)))};
}

/// Difference of the means in standard errors; of two exact values that differ by more than rounding,
/// infinity.
inline double deviation(const std::vector<double>& a, const std::vector<double>& b) {
    const Spread first = spread_of(a);
    const Spread second = spread_of(b);
    const double rounding = 1e-5 * std::max(std::abs(first.mean), std::abs(second.mean));
    const double gap = std::max(0.0, std::abs(first.mean - second.mean) - rounding);
    return gap > 0.0 ? gap / std::hypot(first.error, second.error) : 0.0;
}

}  // namespace nearlight::test
