// SPDX-License-Identifier: Apache-2.0
// Numbers in messages.
#pragma once

#include <array>
#include <charconv>
#include <string>

namespace nearlight::core {

/// The number with two significant digits and a decimal point, whatever the locale.
inline std::string short_text(float value) {
    std::array<char, 32> text{};
    constexpr int kDigits = 2;
    char* const end =
        std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::general, kDigits).ptr;
    return {text.data(), end};
}

}  // namespace nearlight::core
