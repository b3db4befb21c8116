// SPDX-License-Identifier: Apache-2.0
// WebP by its own library: OpenImageIO 2.4 multiplies its colours by alpha, whatever it is asked, and what is
// multiplied by 0 is lost.
#pragma once

#include <filesystem>
#include <optional>
#include <span>

#include "host/image/image_codec.h"

namespace nearlight::core {

/// Reads a WebP image, R, G, B and, if it has it, A: from `bytes`, the content of a file in memory, or from
/// `file` itself if `bytes` is empty. Nothing if it is not WebP. Throws Error(ErrorKind::file) if it is
/// damaged.
std::optional<Image> decode_webp(const std::filesystem::path& file, std::span<const std::byte> bytes);

}  // namespace nearlight::core
