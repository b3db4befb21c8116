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
    bool is_number = false;  ///< one number, the luminance of the colour
    bool is_signed = false;  ///< numbers below 0 mean something
    /// This channel alone, or −1 for all. 3 is alpha, which is 1 where there is none.
    int channel = -1;
    bool is_encoded = false;     ///< whether `gamma` holds for a channel but alpha; others are linear
    bool prefers_alpha = false;  ///< alpha alone, of images in which it is not 1 everywhere
    bool is_inverse = false;     ///< the texel is 1 − factor·number of the channel instead of the number
    float factor = 1.0f;
    /// The x and y of a map of normals become steepness_x·x + x_of_y·y and y_of_x·x + steepness_y·y, which
    /// makes the map steeper, turns it or turns it over.
    float steepness_x = 1.0f;
    float steepness_y = 1.0f;
    float x_of_y = 0.0f;
    float y_of_x = 0.0f;
    /// Alpha multiplies linear colours. With an `alpha_cutoff` above 0, alpha counts as 1 from there on, and
    /// as 0 below.
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
