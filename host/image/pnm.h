// SPDX-License-Identifier: Apache-2.0
// Binary PPM and PGM files with 8 bits a channel [netpbm], which are read without OpenImageIO.
#pragma once

#include <filesystem>
#include <optional>

#include "host/image/image.h"

namespace nearlight::core {

/// Reads a file with values in [0, 1], sRGB-encoded, as OpenImageIO gives them. Empty for all other files and
/// for broken ones, whose fault OpenImageIO can then report.
std::optional<Image> read_pnm(const std::filesystem::path& file);

}  // namespace nearlight::core
