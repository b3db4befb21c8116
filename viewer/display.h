// SPDX-License-Identifier: Apache-2.0
// Turns a layer of a picture into the colours of a screen.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "nearlight/image.h"

namespace nearlight::viewer {

/// A layer of pictures that can be shown.
struct ShownLayer {
    const char* name;  ///< as in files; "beauty" is R, G and B
    const char* what;  ///< for a tooltip
};
/// The layers in the order of the menu: those that files get unless others are asked for. The first is the
/// beauty.
std::span<const ShownLayer> shown_layers();

struct DisplaySettings {
    std::size_t layer = 0;                ///< index into shown_layers()
    float exposure = 0.0f;                ///< of layers of light, in stops
    ToneCurve curve = ToneCurve::linear;  ///< of layers of light, after the exposure
    bool show_close_range = false;        ///< surfaces of the close range are tinted
};

/// Pixels of a screen: red, green, blue and 255, one byte each, the top row first.
struct ScreenPixels {
    int width = 0;
    int height = 0;
    std::vector<std::uint8_t> rgba{};
};

/// What a screen shows of the picture, which must have all channels of picture_channels(). Light passes
/// through the exposure, the tone curve and the sRGB curve, albedo through the curve alone; directions are
/// shown from −1 to 1, positions from the picture's smallest to its largest, depth from near (white) to far
/// (black).
ScreenPixels to_screen(const Image& image, const DisplaySettings& settings);

/// The distance in metres of what the middle of the picture shows; 0 if it shows nothing.
float depth_in_the_middle(const Image& image);

}  // namespace nearlight::viewer
