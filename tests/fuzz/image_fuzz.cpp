// SPDX-License-Identifier: Apache-2.0
// Images, as textures and pictures are read.
#include <array>
#include <string>

#include "host/image/image_io.h"
#include "nearlight/error.h"
#include "tests/fuzz/targets.h"

namespace nearlight::core::fuzz {

void fuzz_image(Bytes bytes) {
    if (bytes.empty()) {
        return;
    }
    constexpr std::array kExtensions{"exr", "png", "jpg", "hdr", "ppm", "tga", "bmp", "tif", "pfm", "webp"};
    const std::string name = std::string("image.") + kExtensions.at(bytes[0] % kExtensions.size());
    const Bytes rest = bytes.subspan(1);
    try {
        static_cast<void>(read_linear_image(put(name, rest)));
    } catch (const Error&) {
        // What one reader refuses, the other may take.
    }
    try {
        static_cast<void>(read_image(std::as_bytes(rest), name));  // as a glTF file has them
    } catch (const Error&) {
        return;  // was refused
    }
}

}  // namespace nearlight::core::fuzz
