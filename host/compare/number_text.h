// SPDX-License-Identifier: Apache-2.0
// Numbers as the reports print them; what is not finite is a dash.
#pragma once

#include <fmt/format.h>
#include <cmath>
#include <string>

namespace nearlight::core {

/// `digits` significant digits.
inline std::string number_text(double value, int digits = 3) {
    return std::isfinite(value) ? fmt::format("{:.{}g}", value, digits) : "–";
}
/// `digits` digits behind the point.
inline std::string fixed_text(double value, int digits) {
    return std::isfinite(value) ? fmt::format("{:.{}f}", value, digits) : "–";
}
/// "0.0123 ± 0.0011": a value and half the width of its confidence interval, where there is one.
inline std::string interval_text(double value, double half_width, int digits = 3) {
    return number_text(value, digits) + (std::isfinite(half_width) ? " ± " + number_text(half_width, 2) : "");
}

}  // namespace nearlight::core
