// SPDX-License-Identifier: Apache-2.0
#include "host/scene/texture.h"

#include <algorithm>
#include <cmath>

#include "host/base/half.h"

namespace nearlight::core {
namespace {

/// The part of x above its floor, in [0, 1]; rounding gives 1 for a tiny negative x. 0 if x is not finite.
float fraction(float x) {
    return std::isfinite(x) ? x - std::floor(x) : 0.0f;
}

/// The coordinate within the bitmap, in [0, 1], that x stands for.
float fold(float x, uint wrap) {
    if (wrap == NEARLIGHT_WRAP_MIRROR) {
        const float r = 2.0f * fraction(0.5f * x);
        return r > 1.0f ? 2.0f - r : r;
    }
    return wrap == NEARLIGHT_WRAP_CLAMP ? (std::isfinite(x) ? std::clamp(x, 0.0f, 1.0f) : 0.0f) : fraction(x);
}

/// The row or column of the texel with the index i, which is from −1 to n. Beyond the edges of a bitmap that
/// does not repeat lies the texel of the edge, also where it is mirrored there.
int texel_index(int i, int n, uint wrap) {
    if (wrap == NEARLIGHT_WRAP_REPEAT) {
        return i < 0 ? i + n : (i >= n ? i - n : i);
    }
    return std::clamp(i, 0, n - 1);
}

Vec3 mix(Vec3 a, Vec3 b, float weight) {
    return a * (1.0f - weight) + b * weight;
}

/// A bitmap, looked up at points that fold() gives.
struct Bitmap {
    const TextureImage& image;
    const Texture& texture;

    [[nodiscard]] Vec3 texel(int column, int row) const {
        const int x = texel_index(column, image.width, texture.wrap_s);
        const int y = texel_index(row, image.height, texture.wrap_t);
        return texel_color(image, static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                                      static_cast<std::size_t>(x));
    }
    [[nodiscard]] Vec3 nearest(float x, float y) const {
        return texel(static_cast<int>(std::floor(x)), static_cast<int>(std::floor(y)));
    }
    [[nodiscard]] Vec3 bilinear(float x, float y) const {
        const float left = std::floor(x - 0.5f);
        const float top = std::floor(y - 0.5f);
        const int x0 = static_cast<int>(left);
        const int y0 = static_cast<int>(top);
        const float weight = x - 0.5f - left;
        return mix(mix(texel(x0, y0), texel(x0 + 1, y0), weight),
                   mix(texel(x0, y0 + 1), texel(x0 + 1, y0 + 1), weight), y - 0.5f - top);
    }
};

Vec3 bitmap_color(const TextureImage& image, const Texture& texture, float s, float t) {
    const Bitmap bitmap{image, texture};
    const float x = fold(s, texture.wrap_s) * static_cast<float>(image.width);
    const float y = (1.0f - fold(t, texture.wrap_t)) * static_cast<float>(image.height);
    return texture.filter == NEARLIGHT_FILTER_NEAREST ? bitmap.nearest(x, y) : bitmap.bilinear(x, y);
}

/// The parameter that a checkerboard has at (s, t).
const Parameter& field_at(const Texture& texture, float s, float t) {
    return (fraction(s) < 0.5f) == (fraction(t) < 0.5f) ? texture.color0 : texture.color1;
}

Vec3 mean_color(const TextureImage& image) {
    const std::size_t count = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
    std::array<double, 3> sum{};
    for (std::size_t i = 0; i < count; ++i) {
        const Vec3 color = texel_color(image, i);
        sum[0] += static_cast<double>(color.x);
        sum[1] += static_cast<double>(color.y);
        sum[2] += static_cast<double>(color.z);
    }
    const double scale = 1.0 / std::max<double>(1.0, static_cast<double>(count));
    return {static_cast<float>(sum[0] * scale), static_cast<float>(sum[1] * scale),
            static_cast<float>(sum[2] * scale)};
}

}  // namespace

const std::array<float, 256>& srgb_decode_table() {
    static const std::array<float, 256> table = [] {
        std::array<float, 256> values{};
        for (std::size_t code = 0; code < values.size(); ++code) {
            const double encoded = static_cast<double>(code) / 255.0;
            values[code] = static_cast<float>(encoded <= 0.04045 ? encoded / 12.92
                                                                 : std::pow((encoded + 0.055) / 1.055, 2.4));
        }
        return values;
    }();
    return table;
}

Vec3 decode_texel(std::uint32_t texel) {
    const std::array<float, 256>& linear = srgb_decode_table();
    return {linear[texel & 255u], linear[(texel >> 8u) & 255u], linear[(texel >> 16u) & 255u]};
}

Vec3 texel_color(const TextureImage& image, std::size_t texel) {
    if (image.format == NEARLIGHT_TEXELS_HALF) {
        const std::uint32_t low = image.words[2 * texel];
        const std::uint32_t high = image.words[2 * texel + 1];
        return {half_to_float(static_cast<std::uint16_t>(low & 0xffffu)),
                half_to_float(static_cast<std::uint16_t>(low >> 16u)),
                half_to_float(static_cast<std::uint16_t>(high & 0xffffu))};
    }
    const std::uint32_t word = image.words[texel];
    if (image.format == NEARLIGHT_TEXELS_LINEAR8) {
        return Vec3{static_cast<float>(word & 255u), static_cast<float>((word >> 8u) & 255u),
                    static_cast<float>((word >> 16u) & 255u)} *
               (1.0f / 255.0f);
    }
    return decode_texel(word);
}

Vec3 texture_color(const Scene& scene, const SceneTexture& texture, float u, float v, Vec3 vertex_color) {
    const Texture& p = texture.parameters;
    const float s = p.u_scale * u + p.u_shear * v + p.u_offset;
    const float t = p.v_shear * u + p.v_scale * v + p.v_offset;
    if (p.kind == NEARLIGHT_TEXTURE_CHECKERBOARD) {
        return parameter_value(scene, field_at(p, s, t), u, v, vertex_color);
    }
    return p.kind == NEARLIGHT_TEXTURE_VERTEX_COLOR
               ? vertex_color
               : bitmap_color(scene.images[static_cast<std::size_t>(texture.image)], p, s, t);
}

Vec3 parameter_value(const Scene& scene, const Parameter& parameter, float u, float v, Vec3 vertex_color) {
    return parameter.texture < 0
               ? parameter.value
               : parameter.value * texture_color(scene,
                                                 scene.textures[static_cast<std::size_t>(parameter.texture)],
                                                 u, v, vertex_color);
}

Vec3 mean_value(const Scene& scene, const Parameter& parameter) {
    if (parameter.texture < 0) {
        return parameter.value;
    }
    const SceneTexture& texture = scene.textures[static_cast<std::size_t>(parameter.texture)];
    const Texture& p = texture.parameters;
    if (p.kind == NEARLIGHT_TEXTURE_CHECKERBOARD) {
        return parameter.value * ((mean_value(scene, p.color0) + mean_value(scene, p.color1)) * 0.5f);
    }
    return p.kind == NEARLIGHT_TEXTURE_VERTEX_COLOR
               ? parameter.value
               : parameter.value * mean_color(scene.images[static_cast<std::size_t>(texture.image)]);
}

}  // namespace nearlight::core
