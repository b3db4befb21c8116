// SPDX-License-Identifier: Apache-2.0
// Reading and writing image files (through OpenImageIO, but for plain PPM and PGM).
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "host/image/image.h"

namespace nearlight::core {

/// Values are as in the file: 8- and 16-bit data is scaled to [0, 1] but not linearised.
/// Throws Error(ErrorKind::file) naming the file and the reason.
Image read_image(const std::filesystem::path& file);
/// The same of a file in memory; its format follows from the extension of `name`.
Image read_image(std::span<const std::byte> bytes, const std::string& name);
/// The same as the first, with the colours of sRGB-encoded files (8- and 16-bit integers) decoded to linear.
Image read_linear_image(const std::filesystem::path& file);

/// Attributes of an image file.
using Metadata = std::map<std::string, std::variant<int, float, std::string, std::vector<float>>>;

/// Of an image file: what its attributes hold as int, float or string; others are left out. Throws as
/// read_image() does.
Metadata read_metadata(const std::filesystem::path& file);

struct ImageWriterOptions {
    Metadata metadata;      ///< EXR attributes; a vector of 16 floats becomes a matrix
    float exposure = 0.0f;  ///< PNG: stops, applied before the sRGB curve
};

/// Writes rows from top to bottom as they come, so that no whole picture need be in memory. The data goes to
/// a temporary file beside the target; commit() renames it, anything else leaves an old file untouched.
class ImageWriter {
  public:
    /// EXR keeps all channels (32-bit float, ZIP); PNG takes R, G, B, tone-mapped to 8-bit sRGB with a
    /// deterministic dither-free rounding. The format follows the extension.
    /// Throws Error(ErrorKind::invalid_argument) for an unknown extension, Error(ErrorKind::file) for an
    /// unwritable path.
    ImageWriter(const std::filesystem::path& file, int width, int height, std::vector<std::string> channels,
                const ImageWriterOptions& options = {});
    ~ImageWriter();
    ImageWriter(ImageWriter&&) noexcept;
    ImageWriter& operator=(ImageWriter&&) noexcept;

    /// The next rows: a multiple of width·channels values.
    void write_rows(std::span<const float> values);
    /// Fills rows that were not written with zeros, closes the file and moves it into place. `late` replaces
    /// values of float metadata that were given at the start (EXR only).
    void commit(const std::map<std::string, float>& late = {});

  private:
    struct State;
    std::unique_ptr<State> state_;
};

/// The whole image at once.
void write_image(const std::filesystem::path& file, const Image& image,
                 const ImageWriterOptions& options = {});

}  // namespace nearlight::core
