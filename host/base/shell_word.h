// SPDX-License-Identifier: Apache-2.0
// Words of a shell's command line.
#pragma once

#include <string>

namespace nearlight::core {

/// The text as a word of a shell's command line, in quotes if it needs them.
inline std::string shell_word(const std::string& text) {
    constexpr const char* kPlain =
        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./=,:+@%^";
    if (!text.empty() && text.find_first_not_of(kPlain) == std::string::npos) {
        return text;
    }
    std::string word = "'";
    for (const char c : text) {
        word += c == '\'' ? std::string("'\\''") : std::string(1, c);
    }
    return word + "'";
}

}  // namespace nearlight::core
