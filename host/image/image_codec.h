// SPDX-License-Identifier: Apache-2.0
// What OpenImageIO does for image_io.cpp. It is in a module of its own (oiio_codec.cpp), which is loaded when
// it is first needed: OpenImageIO brings 250 shared libraries along, and they take longer to load than all
// else that `nearlight` does before it renders.
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

/// A file that is to be written through `stream`, which stays the caller's.
struct EncodingTask {
    std::FILE* stream = nullptr;
    std::string name;
    ImageFormat format = ImageFormat::exr;
    int width = 0;
    int height = 0;
    std::vector<std::string> channels;
    Metadata metadata;
};

/// Pixels into an open file. Both functions give the reason why they failed, empty where they did not.
class ImageEncoder {
  public:
    ImageEncoder() = default;
    ImageEncoder(const ImageEncoder&) = delete;
    ImageEncoder& operator=(const ImageEncoder&) = delete;
    virtual ~ImageEncoder() = default;

    /// Rows [first, end): all channels as floats for EXR, three bytes a pixel for PNG.
    virtual std::string write(int first, int end, const void* values) = 0;
    virtual std::string close() = 0;
};

/// Pixels of a file, and whether colours are sRGB-encoded.
struct DecodedImage {
    Image image;
    bool is_srgb = false;
};

/// What the module exports as `nearlight_image_codec`. All throw what image_io.h says.
struct ImageCodec {
    /// `bytes`: the file, where it is in memory; else empty.
    DecodedImage (*read)(const std::filesystem::path& file, std::span<const std::byte> bytes);
    Metadata (*read_metadata)(const std::filesystem::path& file);
    std::unique_ptr<ImageEncoder> (*make_encoder)(const EncodingTask& task);
};

/// Loads the module where that is not done yet. Throws Error(ErrorKind::failure) where it is missing.
const ImageCodec& image_codec();

/// "cannot read image 'FILE': reason", in one line, whatever line breaks the reason has.
[[noreturn]] void fail_image(const char* what, const std::filesystem::path& file, std::string reason);

/// A broken header may promise any size. Deflate, the densest of the compressions in use, packs about 1000
/// to 1.
bool fits_in_file(std::uintmax_t image_bytes, std::uintmax_t file_size);

}  // namespace nearlight::core
