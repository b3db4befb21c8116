// SPDX-License-Identifier: Apache-2.0
#include "host/image/exr_patch.h"

#include <array>
#include <bit>
#include <cstdint>
#include <fstream>

#include "nearlight/error.h"

namespace nearlight::core {

// An attribute is its name and type, each ended by a zero byte, the size of the value as a 32-bit integer,
// and the value; all little-endian [The OpenEXR File Layout].
void patch_exr_float(const std::filesystem::path& file, const std::string& name, float value) {
    using namespace std::string_literals;
    const std::string attribute = name + "\0float\0\4\0\0\0"s;
    std::fstream stream(file, std::ios::binary | std::ios::in | std::ios::out);
    std::string header(std::size_t{1} << 16u, '\0');
    stream.read(header.data(), static_cast<std::streamsize>(header.size()));
    header.resize(static_cast<std::size_t>(stream.gcount()));
    stream.clear();
    const std::size_t at = header.find(attribute);
    if (at == std::string::npos) {
        throw Error(ErrorKind::file,
                    "cannot update '" + file.string() + "': its header has no number '" + name + "'");
    }
    const auto bits = std::bit_cast<std::uint32_t>(value);
    std::array<char, 4> bytes{};
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        bytes[i] = static_cast<char>(static_cast<unsigned char>(bits >> (8 * i)));
    }
    stream.seekp(static_cast<std::streamoff>(at + attribute.size()));
    stream.write(bytes.data(), bytes.size());
    if (!stream.flush()) {
        throw Error(ErrorKind::file, "cannot update '" + file.string() + "'");
    }
}

}  // namespace nearlight::core
