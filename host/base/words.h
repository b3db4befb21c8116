// SPDX-License-Identifier: Apache-2.0
// Words and lists of them as text.
#pragma once

#include <algorithm>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace nearlight::core {

/// The letter as a small one, if it is an ASCII letter. Unlike std::tolower(), this does not follow the
/// locale, which programs that embed the library may have set.
constexpr char lower_case(char letter) {
    return letter >= 'A' && letter <= 'Z' ? static_cast<char>(letter - 'A' + 'a') : letter;
}
inline std::string lower_case(std::string text) {
    std::ranges::transform(text, text.begin(), [](char letter) { return lower_case(letter); });
    return text;
}
/// Whether the texts are the same but for the case of ASCII letters.
inline bool equal_in_any_case(std::string_view a, std::string_view b) {
    return std::ranges::equal(a, b, [](char x, char y) { return lower_case(x) == lower_case(y); });
}

/// What stands between the separators; an empty text is one empty word.
inline std::vector<std::string> split(std::string_view text, char separator) {
    std::vector<std::string> words(1);
    for (const char c : text) {
        if (c == separator) {
            words.emplace_back();
        } else {
            words.back() += c;
        }
    }
    return words;
}

/// The items as `text` spells each, with the separator between them.
template <typename Items, typename Text = std::identity>
std::string joined(const Items& items, std::string_view separator, const Text& text = {}) {
    std::string result;
    bool is_first = true;
    for (const auto& item : items) {
        if (!is_first) {
            result += separator;
        }
        result += std::invoke(text, item);
        is_first = false;
    }
    return result;
}

}  // namespace nearlight::core
