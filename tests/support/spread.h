// SPDX-License-Identifier: Apache-2.0
// A mean and its standard error.
#pragma once

#include <cmath>
#include <vector>

namespace nearlight::core::test {

struct Spread {
    double mean = 0;
    double error = 0;  ///< standard error of the mean
};

/// Mean and standard error of two or more values.
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

}  // namespace nearlight::core::test
