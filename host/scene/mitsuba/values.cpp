// SPDX-License-Identifier: Apache-2.0
#include "host/scene/mitsuba/values.h"

#include <cctype>
#include <charconv>
#include <sstream>

#include "host/scene/file_text.h"
#include "host/scene/texture.h"
#include "nearlight/error.h"

namespace nearlight::core::mitsuba {
namespace {

constexpr const char* kSeparators = ", \t\r\n";

}  // namespace

std::vector<std::string> split_words(const std::string& text) {
    std::vector<std::string> words;
    for (std::size_t begin = text.find_first_not_of(kSeparators); begin != std::string::npos;) {
        const std::size_t end = std::min(text.find_first_of(kSeparators, begin), text.size());
        words.push_back(text.substr(begin, end - begin));
        begin = text.find_first_not_of(kSeparators, end);
    }
    return words;
}

std::string snake_case(const std::string& name) {
    std::string snake;
    for (std::size_t i = 0; i < name.size(); ++i) {
        const auto c = static_cast<unsigned char>(name[i]);
        if (std::isupper(c) && i > 0 && std::islower(static_cast<unsigned char>(name[i - 1]))) {
            snake += '_';
        }
        snake += static_cast<char>(std::tolower(c));
    }
    return snake;
}

std::string lower_case(std::string text) {
    for (char& c : text) {
        c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    }
    return text;
}

double parse_number(const std::string& text, const Location& where) {
    const std::size_t first = text.find_first_not_of(" \t\r\n+");
    const std::size_t last = text.find_last_not_of(" \t\r\n");
    double value = 0.0;
    if (first != std::string::npos) {
        const char* end = text.data() + last + 1;
        const auto [stop, error] = std::from_chars(text.data() + first, end, value);
        if (error == std::errc() && stop == end && std::isfinite(value)) {
            return value;
        }
        if (error == std::errc::result_out_of_range && stop == end &&
            text.find_first_of("eE") != std::string::npos &&
            text.find("-", text.find_first_of("eE")) != std::string::npos) {
            return 0.0;  // too small for a double
        }
    }
    fail(where, "'" + text + "' is not a finite number");
}

std::vector<double> parse_numbers(const std::string& text, const Location& where) {
    std::vector<double> numbers;
    for (const std::string& word : split_words(text)) {
        numbers.push_back(parse_number(word, where));
    }
    return numbers;
}

Color parse_rgb(const std::string& text, const Location& where) {
    const std::vector<std::string> words = split_words(text);
    if (words.size() == 1 && words[0].size() == 7 && words[0][0] == '#') {
        std::uint32_t code = 0;
        const char* end = words[0].data() + 7;
        if (std::from_chars(words[0].data() + 1, end, code, 16).ptr == end) {
            const std::uint32_t texel = (code >> 16) | (code & 0xff00u) | ((code & 0xffu) << 16);
            const Vec3 rgb = decode_texel(texel);
            return {rgb, rgb};
        }
    }
    const std::vector<double> n = parse_numbers(text, where);
    if (n.size() != 1 && n.size() != 3) {
        fail(where, "'" + text + "' is not a colour: one or three numbers, or #rrggbb");
    }
    const Vec3 rgb{static_cast<float>(n[0]), static_cast<float>(n[n.size() / 2]),
                   static_cast<float>(n.back())};
    return {rgb, rgb};
}

}  // namespace nearlight::core::mitsuba
