// SPDX-License-Identifier: Apache-2.0
#include "host/compare/statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace nearlight::core {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// P(|T| ≤ t) as a finite sum [Abramowitz and Stegun, Handbook of Mathematical Functions, 26.7.3 and 26.7.4].
double two_sided_probability(double t, std::size_t degrees_of_freedom) {
    const auto n = static_cast<double>(degrees_of_freedom);
    const double theta = std::atan(t / std::sqrt(n));
    const double cosine = std::cos(theta);
    const bool odd = degrees_of_freedom % 2 == 1;
    double term = odd ? cosine : 1.0;
    double sum = 0.0;
    for (std::size_t k = odd ? 1 : 0; k + 2 <= degrees_of_freedom; k += 2) {
        sum += term;
        const auto index = static_cast<double>(k);
        term *= cosine * cosine * (index + 1.0) / (index + 2.0);
    }
    const double partial = std::sin(theta) * sum;
    return odd ? 2.0 / std::numbers::pi * (theta + partial) : partial;
}

bool is_usable(double value) {
    return std::isfinite(value) && value > 0.0;
}

}  // namespace

double student_t_975(std::size_t degrees_of_freedom) {
    double low = 0.0;
    double high = 16.0;  // that of 1 degree of freedom is 12.7, and it falls from there
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (low + high);
        (two_sided_probability(middle, degrees_of_freedom) < 0.95 ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

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
    return {mean, student_t_975(values.size() - 1) * std::sqrt(squares / (n - 1.0) / n)};
}

double median(std::span<const double> values) {
    if (values.empty()) {
        return kNan;
    }
    std::vector<double> sorted(values.begin(), values.end());
    std::sort(sorted.begin(), sorted.end());
    const std::size_t middle = sorted.size() / 2;
    return sorted.size() % 2 == 1 ? sorted[middle] : 0.5 * (sorted[middle - 1] + sorted[middle]);
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
