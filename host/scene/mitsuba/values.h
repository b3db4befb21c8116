// SPDX-License-Identifier: Apache-2.0
// Numbers and colours as Mitsuba files write them.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "host/scene/mitsuba/object.h"

namespace nearlight::core::mitsuba {

/// Turns "toWorld" into "to_world", and "intIOR" into "int_ior".
std::string snake_case(const std::string& name);
/// The number that the whole text is. Calls fail() for any other text.
double parse_number(const std::string& text, const Location& where);
/// The words that commas or white space separate.
std::vector<std::string> split_words(const std::string& text);
/// Numbers that commas or white space separate.
std::vector<double> parse_numbers(const std::string& text, const Location& where);
/// How the numbers of a colour are meant. Mitsuba 2 and 3 have linear numbers, and #rrggbb in sRGB. In files
/// of 0.5 and 0.6, the element <rgb> has both linear, and <srgb> both in sRGB.
struct ColorCode {
    bool are_numbers_srgb = false;
    bool is_hex_srgb = true;
};
/// The colour that one or three numbers, or #rrggbb, stand for.
Color parse_rgb(const std::string& text, const Location& where, ColorCode code = {});

}  // namespace nearlight::core::mitsuba
