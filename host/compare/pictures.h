// SPDX-License-Identifier: Apache-2.0
// Operations on pictures, which are images with the channels R, G, B in linear sRGB.
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
/// if a channel is missing.
Image color_layer(const Image& image, const std::string& layer);
std::vector<Vec3> pixels_of(const Image& picture);

Image scaled(Image picture, float factor);
Image cropped(const Image& picture, const Crop& crop);
/// The picture divided by the smallest whole number that makes it at most `max_width` pixels wide. Each pixel
/// is the mean of the pixels that it replaces.
Image shrunk(const Image& picture, int max_width);
/// The picture with each pixel enlarged to a square of `factor` × `factor` pixels.
Image enlarged(const Image& picture, int factor);

/// Factor by which a picture is multiplied for display: the luminance that 95 % of its pixels stay below
/// becomes 0.7. 1 for a black picture.
float display_scale(const Image& picture);

/// Map of the signed relative error of luminance, (a − b)/(b + a twentieth of b's mean); b is the reference.
/// Blue means too little light, white no error, red too much light. Colours saturate at ±kErrorMapLimit.
Image signed_error_map(const Image& picture, const Image& reference);
inline constexpr float kErrorMapLimit = 0.5f;
/// The sRGB-encoded colour of a signed error from −1 to 1, in units of kErrorMapLimit.
Vec3 error_color(float error);

/// Up to `count` parts of the picture with the largest squared error, the worst first. They have a quarter of
/// its width and height and do not overlap.
std::vector<Crop> hardest_crops(const Image& picture, const Image& reference, std::size_t count);

}  // namespace nearlight::core
