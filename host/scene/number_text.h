// SPDX-License-Identifier: Apache-2.0
// Numbers and colours in text, as scene files and options write them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "host/base/math.h"

namespace nearlight::core {

/// The number that the whole text is, with white space around it and a plus sign before it if it likes. It
/// may be infinite or NaN; those too small for a double are 0, those too large infinite, with their sign.
/// Empty for any other text.
std::optional<double> number_in(const std::string& text);
/// The numbers that commas separate. Empty for any other text.
std::optional<std::vector<double>> numbers_in(const std::string& text);
/// The linear colour that #rrggbb (sRGB) stands for. Empty for any other text.
std::optional<Vec3> hex_color_in(const std::string& text);

}  // namespace nearlight::core
