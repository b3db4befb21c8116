// SPDX-License-Identifier: Apache-2.0
// Lists of words as text.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace nearlight::core {

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
