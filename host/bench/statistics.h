// SPDX-License-Identifier: Apache-2.0
// Medians and ratios of repeated measurements.
#pragma once

#include <cmath>
#include <vector>

#include "host/base/median.h"
#include "host/bench/seconds.h"

namespace nearlight::core {

inline double median_absolute_deviation(const std::vector<double>& values) {
    const double center = median(values);
    std::vector<double> deviations;
    for (const double value : values) {
        deviations.push_back(std::abs(value - center));
    }
    return median(deviations);
}

/// The readings of one clock, one per repeat.
inline std::vector<double> readings(const std::vector<Seconds>& runs, double Seconds::*clock) {
    std::vector<double> values;
    for (const Seconds& run : runs) {
        values.push_back(run.*clock);
    }
    return values;
}

/// The median of each clock.
inline Seconds medians(const std::vector<Seconds>& runs) {
    return {median(readings(runs, &Seconds::wall)), median(readings(runs, &Seconds::processor))};
}

struct Ratio {
    double median = 0.0;
    double deviation = 0.0;  ///< median absolute deviation
};

/// Their seconds divided by ours, repeat by repeat.
inline Ratio ratio(const std::vector<Seconds>& theirs, const std::vector<Seconds>& ours,
                   double Seconds::*clock) {
    std::vector<double> ratios;
    for (std::size_t i = 0; i < ours.size(); ++i) {
        ratios.push_back((theirs[i].*clock) / (ours[i].*clock));
    }
    return {median(ratios), median_absolute_deviation(ratios)};
}

}  // namespace nearlight::core
