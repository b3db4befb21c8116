// SPDX-License-Identifier: Apache-2.0
// Reading and writing image files, through OpenImageIO except for WebP and for plain PPM and PGM.
#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "host/image/image.h"
#include "host/image/tone_curve.h"

namespace nearlight::core {

/// Reads an image with the values of the file: 8- and 16-bit data is scaled to [0, 1] but not linearised.
/// Throws Error(ErrorKind::file), which names the file and the reason.
Image read_image(const std::filesystem::path& file);
/// Reads an image file that is in memory, with the values of the file. Messages say `name`, whose extension
/// tells no format but Targa. Throws Error(ErrorKind::file).
Image read_image(std::span<const std::byte> bytes, const std::string& name);
/// Reads an image with linear colours: those of sRGB-encoded files (8- and 16-bit integers) are decoded.
/// Throws Error(ErrorKind::file).
Image read_linear_image(const std::filesystem::path& file);

/// Loads the libraries that read and write image files, which otherwise happens when the first file needs
/// them and takes some tenths of a second. Any thread may call it. Throws Error(ErrorKind::failure) if they
/// are missing, as the first use of them would.
void load_image_libraries();

/// Attributes of an image file.
using Metadata = std::map<std::string, std::variant<int, float, std::string, std::vector<float>>>;

/// The attributes of an image file that are an int, a float or a string. Throws Error(ErrorKind::file).
Metadata read_metadata(const std::filesystem::path& file);

/// How EXR files are compressed. All but `dwaa` are lossless; it changes colours by little, in a third of the
/// space.
enum class ExrCompression { none, zip, piz, dwaa };
/// The names of all compressions, which are OpenImageIO's too.
inline constexpr std::array kExrCompressions{
    std::pair{"none", ExrCompression::none}, std::pair{"zip", ExrCompression::zip},
    std::pair{"piz", ExrCompression::piz}, std::pair{"dwaa", ExrCompression::dwaa}};

struct ImageWriterOptions {
    /// EXR attributes, where a vector of 16 floats becomes a matrix; PNG keeps those that are strings.
    Metadata metadata{};
    float exposure = 0.0f;                ///< stops, applied before the tone curve; PNG only
    ToneCurve curve = ToneCurve::linear;  ///< applied before the sRGB curve; PNG only
    ExrCompression compression = ExrCompression::zip;
    /// For each channel, whether EXR files have it as 16-bit floats, whose maximum is 65504; empty: none.
    std::vector<bool> half{};
    /// EXR files of a part have it as their data window, and the larger picture as their display window.
    std::optional<ImagePlace> place{};
};

/// Writes rows from top to bottom as they come, so that the whole picture need not be in memory. The data
/// goes to a temporary file beside the target, which commit() renames. Without a commit, an old file stays as
/// it is.
class ImageWriter {
  public:
    /// The extension tells the format. EXR keeps all channels; PNG takes R, G and B, tone-mapped to 8-bit
    /// sRGB by deterministic rounding without dithering. Throws Error(ErrorKind::invalid_argument) for an
    /// unknown extension, and Error(ErrorKind::file) if the path cannot be written, if the picture has no
    /// pixels, or if it lacks R, G or B, which PNG needs.
    ImageWriter(const std::filesystem::path& file, int width, int height, std::vector<std::string> channels,
                const ImageWriterOptions& options = {});
    ~ImageWriter();
    ImageWriter(ImageWriter&&) noexcept;
    ImageWriter& operator=(ImageWriter&&) noexcept;

    /// Sets an attribute of the metadata that is a text. Files take it only before their first rows.
    void set_text(const std::string& name, const std::string& text);
    /// Writes the next rows, a multiple of width·channels values. Throws Error(ErrorKind::failure) for values
    /// that are not whole rows or too many, and Error(ErrorKind::file) if they cannot be written.
    void write_rows(std::span<const float> values);
    /// Fills rows that were not written with zeros, closes the file and moves it into place. `late` replaces
    /// values of float metadata that were given at the start (EXR only). Throws Error(ErrorKind::file) if the
    /// file cannot be written to its end, or not be moved.
    void commit(const std::map<std::string, float>& late = {});
    /// How many values of 16-bit channels were too large for them so far.
    [[nodiscard]] std::size_t limited_count() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

/// Writes a whole image at once; see ImageWriter for formats and errors.
void write_image(const std::filesystem::path& file, const Image& image,
                 const ImageWriterOptions& options = {});

}  // namespace nearlight::core
