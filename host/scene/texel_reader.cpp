// SPDX-License-Identifier: Apache-2.0
#include "host/scene/texel_reader.h"

#include <algorithm>
#include <cmath>

#include "host/base/math.h"
#include "host/image/color.h"

namespace nearlight::core {
namespace {

float channel_at(const Image& image, std::size_t pixel, int channel) {
    const std::size_t channels = image.channel_count();
    const float* p = image.values.data() + pixel * channels;
    if (channel == 3) {
        return channels == 2 || channels >= 4 ? p[channels == 2 ? 1 : 3] : 1.0f;
    }
    return channels < 3 ? p[0] : p[channel];
}

/// Whether the image has alpha, and not 1 everywhere.
bool is_transparent(const Image& image) {
    for (std::size_t pixel = 0; pixel < image.pixel_count(); ++pixel) {
        if (channel_at(image, pixel, 3) != 1.0f) {
            return true;
        }
    }
    return false;
}

bool is_grey(const std::array<float, 3>& rgb) {
    return rgb[0] == rgb[1] && rgb[1] == rgb[2];
}

/// The code of 8 bits that stands for a number, or −1 if none does. A number may be off by what scaling a
/// code to [0, 1] has rounded.
int code_of(float number) {
    const float scaled = number * 255.0f;
    if (!(scaled >= 0.0f && scaled <= 255.0f)) {
        return -1;
    }
    const int code = static_cast<int>(scaled + 0.5f);
    return std::fabs(scaled - static_cast<float>(code)) < 1e-3f ? code : -1;
}

/// Writes one word for each texel. Returns false at the first one whose numbers are no codes of 8 bits.
template <typename Source>
bool pack_bytes(std::vector<std::uint32_t>& words, const Source& source) {
    for (std::size_t i = 0; i < words.size(); ++i) {
        const std::array<float, 3> rgb = source(i);
        const int red = code_of(rgb[0]);
        const int green = code_of(rgb[1]);
        const int blue = code_of(rgb[2]);
        if ((red | green | blue) < 0) {
            return false;
        }
        words[i] = 0xff000000u | static_cast<std::uint32_t>(red) | (static_cast<std::uint32_t>(green) << 8u) |
                   (static_cast<std::uint32_t>(blue) << 16u);
    }
    return true;
}

}  // namespace

TexelReader::TexelReader(const Image& image, const TexelRule& rule)
    : image_(image),
      rule_(rule),
      channel_(rule.prefers_alpha && is_transparent(image) ? 3 : rule.channel),
      gamma_(is_linear() ? 1.0f : (rule.gamma > 0.0f || !image.holds_floats ? rule.gamma : 1.0f)) {}

std::optional<std::vector<std::uint32_t>> TexelReader::bytes() const {
    const bool is_standard = gamma_ == 0.0f || gamma_ == 1.0f;
    if (image_.holds_floats || !is_standard) {
        return std::nullopt;
    }
    std::vector<std::uint32_t> words(image_.pixel_count());
    const bool is_plain = channel_ < 0 && !rule_.times_alpha && !rule_.is_number && !is_steepened();
    const bool fits = is_plain ? pack_bytes(words, [&](std::size_t pixel) { return rgb_at(image_, pixel); })
                               : pack_bytes(words, [&](std::size_t pixel) { return undecoded(pixel); });
    return fits ? std::optional(std::move(words)) : std::nullopt;
}

uint TexelReader::byte_format() const {
    return gamma_ == 1.0f ? NEARLIGHT_TEXELS_LINEAR8 : NEARLIGHT_TEXELS_SRGB8;
}

std::array<float, 3> TexelReader::linear(std::size_t pixel) const {
    std::array<float, 3> rgb = numbers(pixel);
    for (float& value : rgb) {
        value = decode(value);
    }
    if (rule_.is_number && !is_grey(rgb)) {
        rgb.fill(luminance(Vec3{rgb[0], rgb[1], rgb[2]}));
    }
    return rgb;
}

/// The numbers of the file that make the texel.
std::array<float, 3> TexelReader::numbers(std::size_t pixel) const {
    if (channel_ >= 0) {
        const float number = channel_at(image_, pixel, channel_);
        const float kept = rule_.is_inverse ? 1.0f - rule_.factor * number : number;
        return {kept, kept, kept};
    }
    std::array<float, 3> rgb = rgb_at(image_, pixel);
    if (rule_.times_alpha) {
        const float alpha = alpha_at(pixel);
        for (float& value : rgb) {
            value = alpha == 0.0f ? 0.0f : alpha == 1.0f ? value : encode(decode(value) * alpha);
        }
    }
    if (is_steepened()) {
        const float x = rgb[0] - 0.5f;
        const float y = rgb[1] - 0.5f;
        rgb[0] = 0.5f + rule_.steepness_x * x + rule_.x_of_y * y;
        rgb[1] = 0.5f + rule_.y_of_x * x + rule_.steepness_y * y;
    }
    return rgb;
}

/// The numbers as they are to be kept, which a texel that stands for one number cannot have as a colour.
std::array<float, 3> TexelReader::undecoded(std::size_t pixel) const {
    const std::array<float, 3> rgb = numbers(pixel);
    constexpr std::array<float, 3> kNoCode{-1.0f, -1.0f, -1.0f};
    return rule_.is_number && !is_grey(rgb) ? kNoCode : rgb;
}

bool TexelReader::is_linear() const {
    return channel_ == 3 || (channel_ >= 0 && !rule_.is_encoded);
}

bool TexelReader::is_steepened() const {
    return rule_.steepness_x != 1.0f || rule_.steepness_y != 1.0f || rule_.x_of_y != 0.0f ||
           rule_.y_of_x != 0.0f;
}

float TexelReader::decode(float value) const {
    return gamma_ == 1.0f   ? value
           : gamma_ == 0.0f ? srgb_to_linear(value)
                            : std::pow(std::max(value, 0.0f), gamma_);
}

float TexelReader::encode(float linear) const {
    return gamma_ == 1.0f   ? linear
           : gamma_ == 0.0f ? linear_to_srgb(linear)
                            : std::pow(std::max(linear, 0.0f), 1.0f / gamma_);
}

float TexelReader::alpha_at(std::size_t pixel) const {
    const float alpha = channel_at(image_, pixel, 3);
    return rule_.alpha_cutoff > 0.0f ? (alpha >= rule_.alpha_cutoff ? 1.0f : 0.0f) : alpha;
}

}  // namespace nearlight::core
