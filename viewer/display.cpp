// SPDX-License-Identifier: Apache-2.0
#include "viewer/display.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "host/image/color.h"
#include "viewer/channels.h"

namespace nearlight::viewer {
namespace {

constexpr std::array kLayers{
    ShownLayer{"beauty", "all light"},
    ShownLayer{"direct", "light that comes straight from emitters"},
    ShownLayer{"indirect", "light that VPLs and rays bring"},
    ShownLayer{"albedo", "how much of the light surfaces reflect"},
    ShownLayer{"N", "normals"},
    ShownLayer{"P", "positions"},
    ShownLayer{"depth", "distance from the camera"},
    ShownLayer{"closerange", "what lies in the close range"},
};

/// The colour that tints the close range, and its share in a pixel there.
constexpr std::array<std::uint8_t, 3> kCloseTint{40, 150, 255};
constexpr float kTintShare = 0.35f;

std::uint8_t to_byte(float value) {
    return static_cast<std::uint8_t>(value > 0.0f ? std::min(value, 1.0f) * 255.0f + 0.5f : 0.0f);
}

/// The sRGB curve, as a table, because millions of powers take longer than a frame may.
class SrgbTable {
  public:
    SrgbTable() {
        for (std::size_t i = 0; i < codes_.size(); ++i) {
            const float linear = static_cast<float>(i) / static_cast<float>(codes_.size() - 1);
            codes_[i] = to_byte(core::linear_to_srgb(linear));
        }
    }
    [[nodiscard]] std::uint8_t code(float linear) const {
        const float last = static_cast<float>(codes_.size() - 1);
        const float place = linear > 0.0f ? std::min(linear, 1.0f) * last + 0.5f : 0.0f;
        return codes_[static_cast<std::size_t>(place)];
    }

  private:
    std::array<std::uint8_t, 16384> codes_{};
};

const SrgbTable& srgb() {
    static const SrgbTable table;
    return table;
}

struct Extent {
    float min = std::numeric_limits<float>::infinity();
    float max = -std::numeric_limits<float>::infinity();
    [[nodiscard]] float part(float value) const { return max > min ? (value - min) / (max - min) : 0.0f; }
};

/// The least and the greatest value of a channel. Zeros do not count, because pixels without a surface have
/// them.
Extent extent_of(const Image& image, std::size_t channel) {
    Extent extent;
    for (std::size_t i = channel; i < image.values.size(); i += image.channels.size()) {
        if (std::isfinite(image.values[i]) && image.values[i] != 0.0f) {
            extent.min = std::min(extent.min, image.values[i]);
            extent.max = std::max(extent.max, image.values[i]);
        }
    }
    return extent;
}

using Triple = std::array<std::uint8_t, 3>;

/// Calls color(pixel's first value of the layer) for each pixel, and puts the result on the screen.
template <typename Color>
void fill(const Image& image, Channels channels, ScreenPixels& screen, const Color& color) {
    const std::size_t stride = image.channels.size();
    for (std::size_t pixel = 0; pixel < screen.rgba.size() / 4; ++pixel) {
        const Triple rgb = color(image.values.data() + pixel * stride + channels.first);
        std::copy(rgb.begin(), rgb.end(), screen.rgba.begin() + static_cast<std::ptrdiff_t>(4 * pixel));
    }
}

void fill_by_layer(const Image& image, const DisplaySettings& settings, ScreenPixels& screen) {
    const std::string_view name = kLayers.at(settings.layer).name;
    const Channels channels = channels_of(image, name);
    if (channels.count == 0) {
        return;
    }
    if (name == "N") {
        fill(image, channels, screen, [](const float* n) {
            return Triple{to_byte(0.5f + 0.5f * n[0]), to_byte(0.5f + 0.5f * n[1]),
                          to_byte(0.5f + 0.5f * n[2])};
        });
    } else if (name == "P") {
        const std::array<Extent, 3> extents{extent_of(image, channels.first),
                                            extent_of(image, channels.first + 1),
                                            extent_of(image, channels.first + 2)};
        fill(image, channels, screen, [&](const float* p) {
            return Triple{to_byte(extents[0].part(p[0])), to_byte(extents[1].part(p[1])),
                          to_byte(extents[2].part(p[2]))};
        });
    } else if (channels.count == 1) {
        const bool is_depth = name == "depth";
        const Extent extent = is_depth ? extent_of(image, channels.first) : Extent{0.0f, 1.0f};
        fill(image, channels, screen, [&](const float* v) {
            const bool is_empty = is_depth && !(*v > 0.0f && std::isfinite(*v));
            const float grey = is_depth ? 1.0f - 0.9f * extent.part(*v) : *v;
            return Triple{to_byte(is_empty ? 0.0f : grey), to_byte(is_empty ? 0.0f : grey),
                          to_byte(is_empty ? 0.0f : grey)};
        });
    } else {
        const bool is_light = name != "albedo";
        const float scale = is_light ? std::exp2(settings.exposure) : 1.0f;
        const ToneCurve curve = is_light ? settings.curve : ToneCurve::linear;
        const SrgbTable& table = srgb();
        fill(image, channels, screen, [&](const float* c) {
            Vec3 color{c[0] * scale, c[1] * scale, c[2] * scale};
            if (curve != ToneCurve::linear) {
                color = tone_mapped(curve, color);
            }
            return Triple{table.code(color.x), table.code(color.y), table.code(color.z)};
        });
    }
}

void tint_close_range(const Image& image, ScreenPixels& screen) {
    const Channels close = channels_of(image, "closerange");
    if (close.count == 0) {
        return;
    }
    for (std::size_t pixel = 0; pixel < screen.rgba.size() / 4; ++pixel) {
        const float share = kTintShare * image.values[pixel * image.channels.size() + close.first];
        for (std::size_t i = 0; i < kCloseTint.size(); ++i) {
            std::uint8_t& value = screen.rgba[4 * pixel + i];
            value = static_cast<std::uint8_t>(static_cast<float>(value) * (1.0f - share) +
                                              static_cast<float>(kCloseTint[i]) * share);
        }
    }
}

}  // namespace

std::span<const ShownLayer> shown_layers() {
    return kLayers;
}

float depth_in_the_middle(const Image& image) {
    const Channels depth = channels_of(image, "depth");
    return depth.count > 0 ? image.at(image.width / 2, image.height / 2, depth.first) : 0.0f;
}

ScreenPixels to_screen(const Image& image, const DisplaySettings& settings) {
    ScreenPixels screen{.width = image.width, .height = image.height};
    screen.rgba.assign(static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height) * 4,
                       255);
    fill_by_layer(image, settings, screen);
    if (settings.show_close_range) {
        tint_close_range(image, screen);
    }
    return screen;
}

}  // namespace nearlight::viewer
