// SPDX-License-Identifier: Apache-2.0
// Turns the numbers of an image file into texels.
#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "host/image/image.h"
#include "host/scene/scene.h"

namespace nearlight::core {

/// What the numbers of an image file stand for.
struct TexelRule {
    /// 0: sRGB-encoded, except in files of floats; otherwise linear = number to the power of gamma.
    float gamma = 0.0f;
    bool is_number = false;      ///< one number, the luminance of the colour
    bool is_signed = false;      ///< numbers below 0 mean something
    int channel = -1;            ///< this channel alone, linear; 3 is alpha, which is 1 where there is none
    bool is_encoded = false;     ///< of a channel but alpha: `gamma` holds for it, too
    bool prefers_alpha = false;  ///< alpha alone, of images in which it is not 1 everywhere
    bool is_inverse = false;     ///< of a channel: 1 − factor·number instead of the number
    float factor = 1.0f;
    /// What x and y of a map of normals are multiplied by, which makes it steeper or turns it over.
    float steepness_x = 1.0f;
    float steepness_y = 1.0f;
    /// And what is added to them, times y and x, which turns the map.
    float x_of_y = 0.0f;
    float y_of_x = 0.0f;
    /// Alpha multiplies linear colours; above an `alpha_cutoff` that is not 0, alpha counts as 1, below as 0.
    bool times_alpha = false;
    float alpha_cutoff = 0.0f;

    auto operator<=>(const TexelRule&) const = default;
};

/// The red, green and blue of a pixel. One or two channels are grey (and alpha); three or more are red,
/// green, blue (and alpha).
inline std::array<float, 3> rgb_at(const Image& image, std::size_t pixel) {
    const std::size_t channels = image.channel_count();
    const float* p = image.values.data() + pixel * channels;
    return channels < 3 ? std::array<float, 3>{p[0], p[0], p[0]} : std::array<float, 3>{p[0], p[1], p[2]};
}

class TexelReader {
  public:
    /// Keeps references to the image and the rule.
    TexelReader(const Image& image, const TexelRule& rule);

    /// All texels as words of four bytes (red is the lowest, alpha is 255), if that keeps the image's numbers
    /// as they are; otherwise nothing.
    [[nodiscard]] std::optional<std::vector<std::uint32_t>> bytes() const;
    /// What such words are: NEARLIGHT_TEXELS_SRGB8 or NEARLIGHT_TEXELS_LINEAR8.
    [[nodiscard]] uint byte_format() const;
    /// The texel, decoded.
    [[nodiscard]] std::array<float, 3> linear(std::size_t pixel) const;

  private:
    [[nodiscard]] std::array<float, 3> numbers(std::size_t pixel) const;
    [[nodiscard]] std::array<float, 3> undecoded(std::size_t pixel) const;
    [[nodiscard]] bool is_linear() const;
    [[nodiscard]] bool is_steepened() const;
    [[nodiscard]] float decode(float value) const;
    [[nodiscard]] float encode(float linear) const;
    [[nodiscard]] float alpha_at(std::size_t pixel) const;

    const Image& image_;
    const TexelRule& rule_;
    int channel_;  // −1: all
    float gamma_;  // 0: sRGB
};

}  // namespace nearlight::core
