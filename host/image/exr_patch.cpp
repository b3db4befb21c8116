// SPDX-License-Identifier: Apache-2.0
#include "host/image/exr_patch.h"

#include <array>
#include <bit>
#include <cstdint>
#include <fstream>
#include <optional>

#include "nearlight/error.h"

namespace nearlight::core {

namespace {

constexpr std::streamoff kFirstAttribute = 8;  // behind the magic number and the version

std::uint32_t read_size(std::istream& stream) {
    std::array<unsigned char, 4> bytes{};
    stream.read(reinterpret_cast<char*>(bytes.data()), bytes.size());
    return bytes[0] | std::uint32_t{bytes[1]} << 8u | std::uint32_t{bytes[2]} << 16u |
           std::uint32_t{bytes[3]} << 24u;
}

/// Where the value of the float begins in the file; empty if the header has none of that name. An attribute
/// is its name and type, each ended by a zero byte, the size of the value as a 32-bit integer, and the value,
/// all little-endian; a zero byte ends them [The OpenEXR File Layout].
std::optional<std::streamoff> find_float(std::istream& stream, const std::string& wanted) {
    stream.seekg(kFirstAttribute);
    for (std::string name, type; std::getline(stream, name, '\0') && !name.empty();) {
        std::getline(stream, type, '\0');
        const std::uint32_t size = read_size(stream);
        if (name == wanted && type == "float" && size == 4 && stream) {
            return stream.tellg();
        }
        stream.seekg(size, std::ios::cur);
    }
    return std::nullopt;
}

}  // namespace

void patch_exr_float(const std::filesystem::path& file, const std::string& name, float value) {
    std::fstream stream(file, std::ios::binary | std::ios::in | std::ios::out);
    const std::optional<std::streamoff> at = find_float(stream, name);
    if (!at) {
        throw Error(ErrorKind::file,
                    "cannot update '" + file.string() + "': its header has no number '" + name + "'");
    }
    const auto bits = std::bit_cast<std::uint32_t>(value);
    std::array<char, 4> bytes{};
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        bytes[i] = static_cast<char>(static_cast<unsigned char>(bits >> (8 * i)));
    }
    stream.seekp(*at);
    stream.write(bytes.data(), bytes.size());
    if (!stream.flush()) {
        throw Error(ErrorKind::file, "cannot update '" + file.string() + "'");
    }
}

}  // namespace nearlight::core
