// SPDX-License-Identifier: Apache-2.0
// Small work on pictures: images with the channels R, G, B, linear sRGB.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "host/base/math.h"
#include "host/compare/settings.h"
#include "host/image/image.h"

namespace nearlight::core {

/// A black picture.
Image make_picture(int width, int height);
/// The channels `layer`.R, .G, .B (or R, G, B for an empty layer) as a picture. Throws Error(ErrorKind::file)
/// where one is missing.
Image color_layer(const Image& image, const std::string& layer);
std::vector<Vec3> pixels_of(const Image& picture);

Image scaled(Image picture, float factor);
Image cropped(const Image& picture, const Crop& crop);
/// Halved, thirded, … until it is at most so wide; a pixel is the mean of those it stands for.
Image shrunk(const Image& picture, int max_width);
/// Each pixel becomes a square of so many.
Image enlarged(const Image& picture, int factor);

/// Factor by which a picture is to be multiplied to be looked at: the luminance that 95 % of its pixels stay
/// below becomes 0.7. 1 for a black picture.
float display_scale(const Image& picture);

/// The signed relative error of luminance, (a − b)/(b + a twentieth of b's mean), b the reference: blue where
/// light is missing, white where it is right, red where there is too much; full colour at ±kErrorMapLimit.
Image signed_error_map(const Image& picture, const Image& reference);
inline constexpr float kErrorMapLimit = 0.5f;
/// The colour of a signed error in units of the limit, −1 to 1, sRGB-encoded.
Vec3 error_color(float error);

/// Up to `count` parts of a quarter of the picture's width and height where the squared error is largest,
/// none over another; the worst first.
std::vector<Crop> hardest_crops(const Image& picture, const Image& reference, std::size_t count);

}  // namespace nearlight::core
