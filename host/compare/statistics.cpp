// SPDX-License-Identifier: Apache-2.0
#include "host/compare/statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "host/base/student_t.h"

namespace nearlight::core {
namespace {

bool is_usable(double value) {
    return std::isfinite(value) && value > 0.0;
}

}  // namespace

Interval mean_interval(std::span<const double> values) {
    const auto n = static_cast<double>(values.size());
    double mean = 0.0;
    for (const double value : values) {
        mean += value / n;
    }
    if (values.size() < 2) {
        return {values.empty() ? kNan : mean, kNan};
    }
    double squares = 0.0;
    for (const double value : values) {
        squares += (value - mean) * (value - mean);
    }
    return {mean, student_t_quantile(0.05, n - 1.0) * std::sqrt(squares / (n - 1.0) / n)};
}

RmseEstimate rmse_estimate(std::span<const double> squared_errors) {
    const auto [mean, half] = mean_interval(squared_errors);
    const auto root = [](double square) {
        return std::isnan(square) ? square : std::sqrt(std::max(0.0, square));
    };
    const double value = root(mean);
    return {value, value > 0.0 ? half / (2.0 * value) : kNan, root(mean - half), root(mean + half)};
}

double PowerLaw::at(double x) const {
    return std::exp(intercept + slope * std::log(x));
}

double PowerLaw::inverse(double y) const {
    return std::exp((std::log(y) - intercept) / slope);
}

std::optional<PowerLaw> fit_power_law(std::span<const double> x, std::span<const double> y) {
    double n = 0, sum_x = 0, sum_y = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        if (is_usable(x[i]) && is_usable(y[i])) {
            n += 1.0;
            sum_x += std::log(x[i]);
            sum_y += std::log(y[i]);
        }
    }
    double xx = 0, xy = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        if (is_usable(x[i]) && is_usable(y[i])) {
            const double dx = std::log(x[i]) - sum_x / n;
            xx += dx * dx;
            xy += dx * (std::log(y[i]) - sum_y / n);
        }
    }
    if (n < 2.0 || !(xx > 1e-12)) {
        return std::nullopt;
    }
    const double slope = xy / xx;
    return PowerLaw{(sum_y - slope * sum_x) / n, slope};
}

}  // namespace nearlight::core
