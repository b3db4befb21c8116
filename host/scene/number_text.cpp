// SPDX-License-Identifier: Apache-2.0
#include "host/scene/number_text.h"

#include <charconv>
#include <cmath>
#include <cstdint>
#include <locale>
#include <sstream>

#include "host/scene/texture.h"

namespace nearlight::core {

namespace {

/// What is nearest to a number that no double has, in the form that from_chars() takes: zero or infinity.
double beyond_doubles(const std::string& text) {
    std::istringstream stream(text);
    stream.imbue(std::locale::classic());
    double value = 0.0;
    stream >> value;
    return std::abs(value) < 1.0 ? 0.0 : std::copysign(HUGE_VAL, value);
}

}  // namespace

std::optional<double> number_in(const std::string& text) {
    std::size_t first = text.find_first_not_of(" \t\r\n");
    const std::size_t last = text.find_last_not_of(" \t\r\n");
    if (first == std::string::npos) {
        return std::nullopt;
    }
    if (text[first] == '+') {
        ++first;
        if (text[first] == '-') {
            return std::nullopt;
        }
    }
    double value = 0.0;
    const char* const end = text.data() + last + 1;
    const auto [stop, error] = std::from_chars(text.data() + first, end, value);
    if (stop != end) {
        return std::nullopt;
    }
    if (error == std::errc::result_out_of_range) {
        return beyond_doubles(text.substr(first, last + 1 - first));
    }
    return error == std::errc() ? std::optional(value) : std::nullopt;
}

std::optional<std::vector<double>> numbers_in(const std::string& text) {
    std::vector<double> numbers;
    for (std::size_t begin = 0; begin <= text.size();) {
        const std::size_t end = std::min(text.find(',', begin), text.size());
        const std::optional<double> number = number_in(text.substr(begin, end - begin));
        if (!number) {
            return std::nullopt;
        }
        numbers.push_back(*number);
        begin = end + 1;
    }
    return numbers;
}

std::optional<Vec3> hex_color_in(const std::string& text) {
    if (text.size() != 7 || text[0] != '#') {
        return std::nullopt;
    }
    std::uint32_t code = 0;
    const char* const end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data() + 1, end, code, 16);
    if (error != std::errc() || stop != end) {
        return std::nullopt;
    }
    return decode_texel((code >> 16) | (code & 0xff00u) | ((code & 0xffu) << 16));
}

}  // namespace nearlight::core
