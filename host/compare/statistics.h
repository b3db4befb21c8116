// SPDX-License-Identifier: Apache-2.0
// Means with confidence intervals, and straight lines through logarithms.
//
// Everything that depends on chance is measured with several seeds; seeds are independent. A mean over n
// seeds has the 95 % interval mean ± t·s/√n, with s the sample standard deviation and t the 0.975 quantile of
// Student's t with n − 1 degrees of freedom. With one seed there is no interval: its half width is NaN.
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <span>

namespace nearlight::core {

/// Stands for a value that is not known.
inline constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

struct Interval {
    double mean = 0;
    double half_width = 0;  ///< of the 95 % interval; NaN for a single value
};
/// Mean and 95 % interval of the values; both NaN for no values.
Interval mean_interval(std::span<const double> values);

/// The root of the mean of squared errors, one for each seed.
struct RmseEstimate {
    double value = 0;  ///< √max(0, mean)
    /// Half the width of the interval about `value`: half width of the mean ÷ (2·value), by the root's
    /// derivative.
    double half_width = 0;
    double low = 0;   ///< root of the lower end of the mean's interval
    double high = 0;  ///< root of the upper end of the mean's interval
};
/// Estimates the RMSE. Squared errors from which the reference's noise was subtracted may be negative.
RmseEstimate rmse_estimate(std::span<const double> squared_errors);

/// The power law y = exp(intercept) · x^slope, fitted by least squares in the logarithms.
struct PowerLaw {
    double intercept = 0;
    double slope = 0;

    [[nodiscard]] double at(double x) const;
    /// The x at which the law reaches y. The slope must not be 0.
    [[nodiscard]] double inverse(double y) const;
};
/// Fits a power law. Pairs with a number that is not positive and finite are left out. Empty if fewer than
/// two different x remain.
std::optional<PowerLaw> fit_power_law(std::span<const double> x, std::span<const double> y);

}  // namespace nearlight::core
