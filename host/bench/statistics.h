// SPDX-License-Identifier: Apache-2.0
// Medians of repeated measurements.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

namespace nearlight {

/// Of at least one value.
inline double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    const std::size_t middle = values.size() / 2;
    return values.size() % 2 == 1 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
}

inline double median_absolute_deviation(const std::vector<double>& values) {
    const double center = median(values);
    std::vector<double> deviations;
    for (const double value : values) {
        deviations.push_back(std::abs(value - center));
    }
    return median(deviations);
}

}  // namespace nearlight
