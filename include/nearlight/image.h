// SPDX-License-Identifier: Apache-2.0
// Floating-point images with named channels, and their files.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "nearlight/export.h"
#include "nearlight/tone_curve.h"
#include "nearlight/vec3.h"

namespace nearlight {

/// Pixels with interleaved channels, the top row first. Channel names follow OpenEXR: "R", "G" and "B" are
/// the picture, "indirect.R" is a channel of the layer "indirect".
struct Image {
    int width = 0;   ///< pixels
    int height = 0;  ///< pixels
    std::vector<std::string> channels{};
    std::vector<float> values{};  ///< width · height · channels.size()

    /// The value of a channel at column x, counted from the left, and row y, counted from the top. Does not
    /// check that the arguments are in range.
    [[nodiscard]] float& at(int x, int y, std::size_t channel) { return values[index(x, y, channel)]; }
    [[nodiscard]] float at(int x, int y, std::size_t channel) const { return values[index(x, y, channel)]; }

  private:
    [[nodiscard]] std::size_t index(int x, int y, std::size_t channel) const {
        return (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)) *
                   channels.size() +
               channel;
    }
};

/// The linear colour that a screen should show, before the sRGB curve. ToneCurve::linear returns the colour
/// as it is; the others are in [0, 1], and take what is negative or NaN for 0.
NEARLIGHT_API Vec3 tone_mapped(ToneCurve curve, Vec3 color);

/// How to write a picture.
struct WriteOptions {
    /// The exposure of PNG files in stops: one stop more doubles the brightness before the tone curve.
    float exposure = 0.0f;
    ToneCurve tone_curve = ToneCurve::linear;  ///< of PNG files, after the exposure
};

/// The layer of a channel: "direct" for "direct.R", "beauty" for R, G and B, and for any other channel
/// without a dot its own name, as "A" for alpha.
NEARLIGHT_API std::string_view layer_of(std::string_view channel);

/// The names of the layers of an image, each once.
NEARLIGHT_API std::vector<std::string> layer_names(const Image& image);

/// A copy of one layer with the layer's name removed from its channels: layer(image, "indirect") has the
/// channels R, G and B. Throws Error: ErrorKind::invalid_argument if there is no such layer.
NEARLIGHT_API Image layer(const Image& image, std::string_view name);

/// Writes a picture by its extension: .exr keeps all channels as 32-bit floats; .png takes R, G and B,
/// applies the exposure, the tone curve and the sRGB curve, and rounds to 8 bits. An existing file is
/// replaced only when the new one is complete. Throws Error: ErrorKind::invalid_argument for another
/// extension; ErrorKind::file if the file cannot be written, or for PNG if R, G or B is missing;
/// ErrorKind::failure if the library's image module is missing. May be called from several threads for
/// different files.
NEARLIGHT_API void write_image(const std::filesystem::path& file, const Image& image,
                               const WriteOptions& options = {});

/// The exposure in stops at which a picture with linear R, G and B looks right on a screen: what is seen is
/// grey on the average, and hardly anything is white. Black pixels do not count. If the picture has the
/// layers albedo and depth, dark surfaces stay rather dark, and what is behind all surfaces decides nothing.
/// Throws Error: ErrorKind::invalid_argument if R, G or B is missing.
NEARLIGHT_API float automatic_exposure(const Image& image);

/// Reads EXR, PNG, JPEG, HDR, TIFF, BMP, GIF, WebP, PSD, DDS, PNM and PFM, which it knows by their content,
/// and Targa, which it knows by the extension. Values are those of the file: integers are scaled to [0, 1],
/// and an sRGB curve is not removed. Throws Error: ErrorKind::file with the file and the reason,
/// ErrorKind::failure if the library's image module is missing. May be called from several threads.
NEARLIGHT_API Image read_image(const std::filesystem::path& file);

/// Reads a picture with linear values, as renders have them: the sRGB curve of files of integers (PNG, JPEG)
/// is removed. Their exposure and tone curve stay. Throws as read_image() does, from any thread.
NEARLIGHT_API Image read_linear_image(const std::filesystem::path& file);

/// How much a picture differs from a reference, over all pixels that are finite in both; NaN if there is
/// none.
struct Difference {
    double rmse = 0;             ///< root of the mean square over pixels and R, G, B
    double relative_mse = 0;     ///< mean of (a − b)² / (b² + 0.01), b the reference
    double mean_ratio = 0;       ///< mean luminance of the picture divided by that of the reference
    double flip = 0;             ///< mean FLIP of the pictures, clamped to [0, 1]: 0 (equal) to 1
    std::size_t non_finite = 0;  ///< pixels with NaN or infinity in either picture
};

/// Compares one layer of a picture with that of a reference of the same size. The layer must have the
/// channels R, G and B, with linear values (read_linear_image()). Throws Error: ErrorKind::invalid_argument
/// if the sizes differ or the layer is missing.
NEARLIGHT_API Difference diff(const Image& image, const Image& reference, std::string_view layer = "beauty");

/// The FLIP error of each pixel as a picture, from dark (equal) to bright. Takes and throws what diff() does.
NEARLIGHT_API Image diff_map(const Image& image, const Image& reference, std::string_view layer = "beauty");

}  // namespace nearlight
