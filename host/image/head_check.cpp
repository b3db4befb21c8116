// SPDX-License-Identifier: Apache-2.0
#include "host/image/head_check.h"

#include "host/image/image_codec.h"

namespace nearlight::core {
namespace {

/// A number of little-endian bytes.
std::uintmax_t number_at(const ImageHead& head, std::size_t begin, std::size_t size) {
    std::uintmax_t number = 0;
    for (std::size_t i = size; i-- > 0;) {
        number = number << 8u | static_cast<unsigned char>(head.at(begin + i));
    }
    return number;
}

}  // namespace

void check_gif_screen(const std::filesystem::path& file, const ImageHead& head, std::uintmax_t file_size) {
    constexpr std::uintmax_t kPixelBytes = 4;
    check_fits_in_file(file, kPixelBytes * number_at(head, 6, 2) * number_at(head, 8, 2), file_size);
}

void check_dds_masks(const std::filesystem::path& file, const ImageHead& head) {
    // Microsoft's DDS_PIXELFORMAT: its flags, and the masks of red, green, blue and alpha.
    const std::uintmax_t flags = number_at(head, 80, 4);
    const bool has_alpha = (flags & 0x1u) != 0;
    const bool is_compressed = (flags & 0x4u) != 0;
    const bool is_rgb = (flags & 0x40u) != 0;
    const bool is_luminance = (flags & 0x20000u) != 0;
    const bool is_alpha_only = (flags & 0x2u) != 0 && !is_luminance;
    if (is_compressed || !(has_alpha || is_rgb || is_luminance || is_alpha_only)) {
        return;
    }
    // OpenImageIO takes the second channel of files that say "alpha only" and "with alpha" for green.
    const std::array is_needed{!is_alpha_only, !is_luminance && (!is_alpha_only || has_alpha),
                               !is_luminance && !is_alpha_only, has_alpha || is_alpha_only};
    for (std::size_t channel = 0; channel < is_needed.size(); ++channel) {
        if (is_needed[channel] && number_at(head, 92 + 4 * channel, 4) == 0) {
            fail_image("cannot read image", file,
                       "its header has no bits for one of its channels; save it as PNG");
        }
    }
}

}  // namespace nearlight::core
