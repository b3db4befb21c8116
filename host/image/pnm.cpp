// SPDX-License-Identifier: Apache-2.0
#include "host/image/pnm.h"

#include <array>
#include <cstdint>
#include <fstream>
#include <limits>
#include <span>

namespace nearlight::core {
namespace {

struct Header {
    std::size_t channel_count = 0;
    std::size_t width = 0, height = 0;
    [[nodiscard]] std::size_t value_count() const { return width * height * channel_count; }
};

/// The next number of a header. White space and comments from # to the end of the line separate numbers.
std::optional<std::size_t> next_number(std::istream& stream) {
    while (stream >> std::ws && stream.peek() == '#') {
        stream.ignore(std::numeric_limits<std::streamsize>::max(), '\n');
    }
    std::size_t number = 0;
    return stream >> number ? std::optional(number) : std::nullopt;
}

/// Reads the header, and leaves the stream at the first pixel.
std::optional<Header> read_header(std::istream& stream) {
    constexpr std::size_t kMaxSide = 65536;
    std::array<char, 2> magic{};
    stream.read(magic.data(), magic.size());
    if (!stream || magic[0] != 'P' || (magic[1] != '5' && magic[1] != '6')) {
        return std::nullopt;
    }
    const auto width = next_number(stream), height = next_number(stream), max_value = next_number(stream);
    if (!width || !height || max_value != 255 || *width - 1 >= kMaxSide || *height - 1 >= kMaxSide) {
        return std::nullopt;
    }
    stream.get();  // one white space ends the header
    return Header{magic[1] == '6' ? 3u : 1u, *width, *height};
}

}  // namespace

std::optional<Image> read_pnm(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    const std::optional<Header> header = stream ? read_header(stream) : std::nullopt;
    std::error_code ignored;
    if (!header || header->value_count() > std::filesystem::file_size(file, ignored)) {
        return std::nullopt;
    }
    std::vector<std::uint8_t> bytes(header->value_count());
    stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    if (!stream) {
        return std::nullopt;
    }
    Image image{static_cast<int>(header->width), static_cast<int>(header->height), {}, {}};
    image.channels =
        header->channel_count == 3 ? std::vector<std::string>{"R", "G", "B"} : std::vector<std::string>{"Y"};
    image.values.reserve(bytes.size());
    for (const std::uint8_t byte : bytes) {
        image.values.push_back(static_cast<float>(byte) * (1.0f / 255.0f));
    }
    return image;
}

}  // namespace nearlight::core
