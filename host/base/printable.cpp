// SPDX-License-Identifier: Apache-2.0
#include "host/base/printable.h"

#include <algorithm>
#include <cstddef>

namespace nearlight::core {
namespace {

constexpr std::size_t kMaxLine = 5000;  // bytes; the longest path has 4096

/// The number of bytes of the character at the beginning; 0 if it is not UTF-8.
std::size_t character_size(std::string_view text) {
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    const std::size_t size = byte(0) < 0x80   ? 1
                             : byte(0) < 0xc2 ? 0
                             : byte(0) < 0xe0 ? 2
                             : byte(0) < 0xf0 ? 3
                             : byte(0) < 0xf5 ? 4
                                              : 0;
    if (size == 0 || text.size() < size) {
        return 0;
    }
    const auto is_continuation = [](char c) { return (static_cast<unsigned char>(c) & 0xc0u) == 0x80u; };
    if (!std::ranges::all_of(text.substr(1, size - 1), is_continuation)) {
        return 0;
    }
    // Second bytes of overlong forms, of surrogates and of what lies beyond the last character.
    const bool is_outside = (byte(0) == 0xe0 && byte(1) < 0xa0) || (byte(0) == 0xed && byte(1) >= 0xa0) ||
                            (byte(0) == 0xf0 && byte(1) < 0x90) || (byte(0) == 0xf4 && byte(1) >= 0x90);
    return is_outside ? 0 : size;
}

}  // namespace

std::string printable(std::string_view text) {
    std::string result;
    result.reserve(text.size());
    while (!text.empty()) {
        const auto c = static_cast<unsigned char>(text.front());
        const std::size_t size = character_size(text);
        const bool is_ascii_control = size == 1 && ((c < 0x20 && c != '\n' && c != '\t') || c == 0x7f);
        const bool is_other_control = size == 2 && c == 0xc2 && static_cast<unsigned char>(text[1]) < 0xa0;
        if (size == 0 || is_ascii_control || is_other_control) {
            result += '?';
        } else {
            result += text.substr(0, size);
        }
        text.remove_prefix(std::max<std::size_t>(size, 1));
    }
    return result;
}

std::string printable_line(std::string_view text) {
    const bool is_cut = text.size() > kMaxLine;
    std::string line = printable(text.substr(0, kMaxLine)) + (is_cut ? " ..." : "");
    std::ranges::replace(line, '\n', ' ');
    return line;
}

std::string utf8_or_latin1(std::string text) {
    std::string_view rest = text;
    std::size_t size = 1;
    while (!rest.empty() && size > 0) {
        size = character_size(rest);
        rest.remove_prefix(size);
    }
    if (rest.empty()) {
        return text;
    }
    std::string converted;
    for (const char c : text) {
        const unsigned code = static_cast<unsigned char>(c);
        if (code < 0x80) {
            converted += c;
        } else {
            converted += static_cast<char>(0xc0u | code >> 6u);
            converted += static_cast<char>(0x80u | (code & 0x3fu));
        }
    }
    return converted;
}

}  // namespace nearlight::core
