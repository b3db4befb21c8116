// SPDX-License-Identifier: Apache-2.0
#include "host/scene/ply_file.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <limits>
#include <sstream>
#include <utility>

#include "host/base/half.h"
#include "nearlight/error.h"

namespace nearlight::core {
namespace {

PlyScalar parse_scalar(const std::filesystem::path& file, std::string_view name) {
    constexpr std::pair<std::string_view, PlyScalar> kNames[] = {
        {"char", PlyScalar::i8},    {"int8", PlyScalar::i8},     {"uchar", PlyScalar::u8},
        {"uint8", PlyScalar::u8},   {"short", PlyScalar::i16},   {"int16", PlyScalar::i16},
        {"ushort", PlyScalar::u16}, {"uint16", PlyScalar::u16},  {"int", PlyScalar::i32},
        {"int32", PlyScalar::i32},  {"uint", PlyScalar::u32},    {"uint32", PlyScalar::u32},
        {"long", PlyScalar::i64},   {"int64", PlyScalar::i64},   {"ulong", PlyScalar::u64},
        {"uint64", PlyScalar::u64}, {"half", PlyScalar::f16},    {"float16", PlyScalar::f16},
        {"float", PlyScalar::f32},  {"float32", PlyScalar::f32}, {"double", PlyScalar::f64},
        {"float64", PlyScalar::f64}};
    for (const auto& [known, type] : kNames) {
        if (known == name) {
            return type;
        }
    }
    fail_ply(file, "PLY header has the unknown type '" + std::string(name) + "'");
}

void parse_header_line(const std::filesystem::path& file, const std::string& line, PlyHeader& header) {
    std::istringstream words(line);
    std::string keyword;
    words >> keyword;
    if (keyword == "format") {
        std::string format;
        words >> format;
        header.format =
            format == "ascii"                  ? PlyFormat::ascii
            : format == "binary_little_endian" ? PlyFormat::little
            : format == "binary_big_endian"
                ? PlyFormat::big
                : (fail_ply(file, "PLY header has the unknown format '" + format + "'"), PlyFormat::ascii);
    } else if (keyword == "element") {
        PlyElement element;
        if (!(words >> element.name >> element.count)) {
            fail_ply(file, "PLY header has a broken line: " + line);
        }
        header.elements.push_back(element);
    } else if (keyword == "property") {
        PlyProperty property;
        std::string type;
        words >> type;
        if (type == "list") {
            std::string count_type;
            words >> count_type >> type;
            property.is_list = true;
            property.count_type = parse_scalar(file, count_type);
        }
        property.type = parse_scalar(file, type);
        if (!(words >> property.name) || header.elements.empty()) {
            fail_ply(file, "PLY header has a broken line: " + line);
        }
        header.elements.back().properties.push_back(property);
    } else if (keyword == "comment") {
        std::string comment;
        std::getline(words >> std::ws, comment);
        header.comments.push_back(comment);
    }
}

/// The last character of each line of the header. Rhinoceros ends lines with a carriage return alone.
char end_of_lines(std::string_view text) {
    const std::string_view after_first = text.substr(std::min<std::size_t>(3, text.size()));
    return after_first.starts_with('\r') && !after_first.starts_with("\r\n") ? '\r' : '\n';
}

}  // namespace

void fail_ply(const std::filesystem::path& file, const std::string& what, std::string_view setting) {
    throw Error(ErrorKind::file, file.string() + ": " + what, setting);
}

double largest_number(PlyScalar type) {
    switch (type) {
        case PlyScalar::i8:
            return std::numeric_limits<std::int8_t>::max();
        case PlyScalar::u8:
            return std::numeric_limits<std::uint8_t>::max();
        case PlyScalar::i16:
            return std::numeric_limits<std::int16_t>::max();
        case PlyScalar::u16:
            return std::numeric_limits<std::uint16_t>::max();
        case PlyScalar::i32:
            return std::numeric_limits<std::int32_t>::max();
        case PlyScalar::u32:
            return std::numeric_limits<std::uint32_t>::max();
        case PlyScalar::i64:
            return static_cast<double>(std::numeric_limits<std::int64_t>::max());
        case PlyScalar::u64:
            return static_cast<double>(std::numeric_limits<std::uint64_t>::max());
        case PlyScalar::f16:
        case PlyScalar::f32:
        case PlyScalar::f64:
            break;
    }
    return 0.0;
}

PlyHeader parse_ply_header(const std::filesystem::path& file, std::string_view text) {
    if (!text.starts_with("ply")) {
        fail_ply(file, "not a PLY file");
    }
    PlyHeader header;
    const char line_end = end_of_lines(text);
    for (std::size_t begin = 0; begin < text.size();) {
        const std::size_t end = text.find(line_end, begin);
        if (end == std::string_view::npos) {
            break;
        }
        std::string line(text.substr(begin, end - begin));
        line.erase(line.find_last_not_of(" \t\r") + 1);
        begin = end + 1;
        if (line == "end_header") {
            header.size = begin;
            return header;
        }
        parse_header_line(file, line, header);
    }
    fail_ply(file, "PLY header is truncated");
}

template <typename T>
T PlyReader::read_binary() {
    if (data_.size() < sizeof(T)) {
        fail_ply(file_, "PLY file is truncated");
    }
    std::array<char, sizeof(T)> bytes;
    std::memcpy(bytes.data(), data_.data(), sizeof(T));
    data_.remove_prefix(sizeof(T));
    if ((format_ == PlyFormat::big) != (std::endian::native == std::endian::big)) {
        std::reverse(bytes.begin(), bytes.end());
    }
    return std::bit_cast<T>(bytes);
}

void PlyReader::fail(const std::string& what) const {
    if (odd_place_ == nullptr) {
        fail_ply(file_, what);
    }
    const std::string_view before(text_.data(), static_cast<std::size_t>(odd_place_ - text_.data()));
    const auto line = 1 + std::ranges::count(before, end_of_lines(text_));
    fail_ply(file_, "line " + std::to_string(line) +
                        " does not hold what the PLY header says of its columns; export the file again (" +
                        what + ")");
}

/// Passes over blanks, ends of lines and, between rows, comments. The first end of a line within a row
/// is remembered.
void PlyReader::skip_blanks() {
    const char* place = data_.data();
    const char* const end = place + data_.size();
    for (; place != end; ++place) {
        const bool ends_line = *place == '\n' || *place == '\r';
        if (ends_line && is_in_row_ && odd_place_ == nullptr) {
            odd_place_ = place;
        }
        if (!is_in_row_ && (std::string_view(place, end).starts_with("comment") ||
                            std::string_view(place, end).starts_with("obj_info"))) {
            place = std::find_if(place, end, [](char c) { return c == '\n' || c == '\r'; });
            if (place == end) {
                break;
            }
        } else if (!ends_line && *place != ' ' && *place != '\t') {
            break;
        }
    }
    data_ = {place, end};
}

void PlyReader::end_row() {
    is_in_row_ = false;
    if (format_ != PlyFormat::ascii || odd_place_ != nullptr) {
        return;
    }
    data_.remove_prefix(std::min(data_.find_first_not_of(" \t"), data_.size()));
    if (!data_.empty() && data_[0] != '\n' && data_[0] != '\r') {
        odd_place_ = data_.data();
    }
}

void PlyReader::check_end() {
    if (format_ != PlyFormat::ascii || odd_place_ == nullptr) {
        return;
    }
    skip_blanks();
    if (!data_.empty()) {
        fail("more numbers stand behind the last row");
    }
}

double PlyReader::read_word() {
    skip_blanks();
    is_in_row_ = true;
    if (data_.empty()) {
        fail("PLY file is truncated");
    }
    double value = 0.0;
    const bool has_plus = data_[0] == '+' && !data_.substr(1).starts_with('-');
    const auto [end, error] =
        std::from_chars(data_.data() + (has_plus ? 1 : 0), data_.data() + data_.size(), value);
    if (error != std::errc()) {
        fail("PLY file has '" + std::string(data_.substr(0, data_.find_first_of(" \t\r\n"))) +
             "' where a number should be");
    }
    data_.remove_prefix(static_cast<std::size_t>(end - data_.data()));
    return value;
}

double PlyReader::read(PlyScalar type) {
    if (format_ == PlyFormat::ascii) {
        return read_word();
    }
    switch (type) {
        case PlyScalar::i8:
            return read_binary<std::int8_t>();
        case PlyScalar::u8:
            return read_binary<std::uint8_t>();
        case PlyScalar::i16:
            return read_binary<std::int16_t>();
        case PlyScalar::u16:
            return read_binary<std::uint16_t>();
        case PlyScalar::i32:
            return read_binary<std::int32_t>();
        case PlyScalar::u32:
            return read_binary<std::uint32_t>();
        case PlyScalar::i64:
            return static_cast<double>(read_binary<std::int64_t>());
        case PlyScalar::u64:
            return static_cast<double>(read_binary<std::uint64_t>());
        case PlyScalar::f16:
            return static_cast<double>(half_to_float(read_binary<std::uint16_t>()));
        case PlyScalar::f32:
            return static_cast<double>(read_binary<float>());
        case PlyScalar::f64:
            return read_binary<double>();
    }
    return 0.0;
}

void PlyReader::skip(const PlyProperty& property) {
    const double count = property.is_list ? read(property.count_type) : 1.0;
    for (double i = 0; i < count; ++i) {
        read(property.type);
    }
}

void PlyReader::check_size_of(const PlyElement& element) const {
    // Each row has a property that takes at least one byte, so larger counts are of a broken header.
    if (element.count > (element.properties.empty() ? 0 : data_.size())) {
        fail_ply(file_, "PLY file is truncated, or its header is broken: it promises " +
                            std::to_string(element.count) + " times '" + element.name + "'");
    }
}

}  // namespace nearlight::core
