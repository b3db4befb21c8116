// SPDX-License-Identifier: Apache-2.0
// The interface to OpenImageIO, which is in a module of its own (oiio_codec.cpp). It is loaded when first
// needed, because OpenImageIO's 250 shared libraries take longer to load than all else that `nearlight` does
// before it renders.
#pragma once

#include <cstdio>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "host/image/image_io.h"

namespace nearlight::core {

enum class ImageFormat { exr, png };

/// A file that is to be written through `stream`, which the caller owns.
struct EncodingTask {
    std::FILE* stream = nullptr;
    std::string name;
    ImageFormat format = ImageFormat::exr;
    int width = 0;
    int height = 0;
    std::vector<std::string> channels;
    std::vector<bool> half;  ///< of each channel; empty: none
    ExrCompression compression = ExrCompression::zip;
    std::optional<ImagePlace> place;
    Metadata metadata;
};

/// Writes pixels to an open file. Both functions return the reason of a failure, or an empty string.
class ImageEncoder {
  public:
    ImageEncoder() = default;
    ImageEncoder(const ImageEncoder&) = delete;
    ImageEncoder& operator=(const ImageEncoder&) = delete;
    virtual ~ImageEncoder() = default;

    /// Writes the rows [first, end): all channels as floats for EXR, three bytes a pixel for PNG.
    virtual std::string write(int first, int end, const void* values) = 0;
    virtual std::string close() = 0;
};

/// The functions that the module exports as `nearlight_image_codec`. They throw the errors that image_io.h
/// names.
struct ImageCodec {
    /// Reads `bytes`, the content of a file in memory, or `file` itself if `bytes` is empty.
    Image (*read)(const std::filesystem::path& file, std::span<const std::byte> bytes);
    Metadata (*read_metadata)(const std::filesystem::path& file);
    std::unique_ptr<ImageEncoder> (*make_encoder)(const EncodingTask& task);
};

/// The functions of the module, which the first call loads. Throws Error(ErrorKind::failure) if it is
/// missing.
const ImageCodec& image_codec();

/// Throws Error(ErrorKind::file) with the line "WHAT 'FILE': REASON". Line breaks in the reason become
/// spaces.
[[noreturn]] void fail_image(const char* what, const std::filesystem::path& file, std::string reason);

/// How many bytes of pixels a byte of a file may stand for. Deflate and LZW pack about 1000 to 1 at best;
/// EXR's DWA packs even pictures some ten times as much.
inline constexpr std::uintmax_t kUsualDensity = 2000;
inline constexpr std::uintmax_t kDwaDensity = 100'000;

/// Throws Error(ErrorKind::file) if `image_bytes` of pixels, more than 256 MiB, are out of proportion to a
/// file of `file_size` bytes, because a broken header may promise any size.
void check_fits_in_file(const std::filesystem::path& file, std::uintmax_t image_bytes,
                        std::uintmax_t file_size, std::uintmax_t densest = kUsualDensity);

}  // namespace nearlight::core
