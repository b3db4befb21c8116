// SPDX-License-Identifier: Apache-2.0
#include "host/scene/mitsuba/values.h"

#include <cctype>

#include "host/image/color.h"
#include "host/scene/number_text.h"

namespace nearlight::core::mitsuba {
namespace {

constexpr const char* kSeparators = ", \t\r\n";

Vec3 decoded(Vec3 c) {
    return {srgb_to_linear(c.x), srgb_to_linear(c.y), srgb_to_linear(c.z)};
}

Vec3 encoded(Vec3 c) {
    return {linear_to_srgb(c.x), linear_to_srgb(c.y), linear_to_srgb(c.z)};
}

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

double parse_number(const std::string& text, const Location& where) {
    const std::optional<double> number = number_in(text);
    if (!number || !std::isfinite(*number)) {
        fail(where, "'" + text + "' is not a finite number");
    }
    return *number;
}

std::vector<double> parse_numbers(const std::string& text, const Location& where) {
    std::vector<double> numbers;
    for (const std::string& word : split_words(text)) {
        numbers.push_back(parse_number(word, where));
    }
    return numbers;
}

Color parse_rgb(const std::string& text, const Location& where, ColorCode code) {
    const std::vector<std::string> words = split_words(text);
    if (const std::optional<Vec3> rgb = hex_color_in(words.size() == 1 ? words[0] : text)) {
        const Vec3 color = code.is_hex_srgb ? *rgb : encoded(*rgb);
        return {color, color};
    }
    const std::vector<double> n = parse_numbers(text, where);
    if (n.size() != 1 && n.size() != 3) {
        fail(where, "'" + text + "' is not a colour: one or three numbers, or #rrggbb");
    }
    const Vec3 given{static_cast<float>(n[0]), static_cast<float>(n[n.size() / 2]),
                     static_cast<float>(n.back())};
    const Vec3 rgb = code.are_numbers_srgb ? decoded(given) : given;
    return {rgb, rgb};
}

}  // namespace nearlight::core::mitsuba
