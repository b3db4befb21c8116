// SPDX-License-Identifier: Apache-2.0
// Looks at the beginning of image files for what OpenImageIO 2.4 does not survive.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>

namespace nearlight::core {

/// The beginning of a file, with zeros behind the end of a shorter one.
using ImageHead = std::array<char, 108>;

/// Throws Error(ErrorKind::file) if the screen of a GIF file is out of proportion to the file's size.
/// OpenImageIO takes memory for the screen as soon as it opens the file.
void check_gif_screen(const std::filesystem::path& file, const ImageHead& head, std::uintmax_t file_size);

/// Throws Error(ErrorKind::file) if the header of a DDS file without compression names no bits for a channel
/// that it has. OpenImageIO would spread these no bits over eight for ever.
void check_dds_masks(const std::filesystem::path& file, const ImageHead& head);

}  // namespace nearlight::core
