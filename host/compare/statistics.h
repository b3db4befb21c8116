// SPDX-License-Identifier: Apache-2.0
// Means with confidence, and straight lines through logarithms.
//
// Everything that depends on chance is measured with several seeds; seeds are independent. A mean over n
// seeds has the 95 % interval mean ± t·s/√n, with s the sample standard deviation and t the 0.975 quantile of
// Student's t with n − 1 degrees of freedom. With one seed there is no interval: its half width is NaN.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

namespace nearlight::core {

struct Interval {
    double mean = 0;
    double half_width = 0;  ///< of the 95 % interval; NaN where there is one value only
};
/// NaN for no values.
Interval mean_interval(std::span<const double> values);
/// The middle value, or the mean of both in the middle; NaN for no values.
double median(std::span<const double> values);

/// Root of the mean of squared errors, one a seed.
struct RmseEstimate {
    double value = 0;       ///< √max(0, mean)
    double half_width = 0;  ///< of `value`, by the derivative of the root: half width of the mean ÷ (2·value)
    double low = 0;         ///< roots of the ends of the interval of the mean, which may be a little lopsided
    double high = 0;
};
/// The squared errors may have had the reference's own noise subtracted, and then be negative.
RmseEstimate rmse_estimate(std::span<const double> squared_errors);

/// y = exp(intercept) · x^slope, by least squares in the logarithms.
struct PowerLaw {
    double intercept = 0;
    double slope = 0;

    [[nodiscard]] double at(double x) const;
    /// The x at which the law reaches y; of no use where the slope is 0.
    [[nodiscard]] double inverse(double y) const;
};
/// Pairs with a number that is not positive and finite are left out. Nothing where fewer than two different x
/// remain.
std::optional<PowerLaw> fit_power_law(std::span<const double> x, std::span<const double> y);

}  // namespace nearlight::core
