// SPDX-License-Identifier: Apache-2.0
// Formats numbers for the reports. A number that is not finite becomes a dash.
#pragma once

#include <fmt/format.h>
#include <cmath>
#include <string>

namespace nearlight::core {

/// The value with `digits` significant digits.
inline std::string number_text(double value, int digits = 3) {
    return std::isfinite(value) ? fmt::format("{:.{}g}", value, digits) : "–";
}
/// The value with `digits` digits after the decimal point.
inline std::string fixed_text(double value, int digits) {
    return std::isfinite(value) ? fmt::format("{:.{}f}", value, digits) : "–";
}
/// A value and half the width of its confidence interval, such as "0.0123 ± 0.0011"; the value alone if
/// `half_width` is NaN.
inline std::string interval_text(double value, double half_width, int digits = 3) {
    return number_text(value, digits) + (std::isfinite(half_width) ? " ± " + number_text(half_width, 2) : "");
}

}  // namespace nearlight::core
