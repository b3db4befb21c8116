// SPDX-License-Identifier: Apache-2.0
#include "host/scene/texture.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "host/base/half.h"

namespace nearlight::core {
namespace {

/// The index of the texel that stands at place i of a row or column of n texels.
int wrap_texel(int i, int n, uint wrap) {
    if (wrap == NEARLIGHT_WRAP_CLAMP) {
        return std::clamp(i, 0, n - 1);
    }
    const int period = wrap == NEARLIGHT_WRAP_MIRROR ? 2 * n : n;
    i %= period;
    i += i < 0 ? period : 0;
    return i < n ? i : period - 1 - i;
}

/// A coordinate near 0 where the texture looks the same, so that large coordinates lose no precision.
float reduce_coordinate(float s, uint wrap) {
    if (!std::isfinite(s)) {
        return 0.0f;
    }
    return wrap == NEARLIGHT_WRAP_CLAMP ? std::clamp(s, -1.0f, 2.0f) : s - 2.0f * std::floor(0.5f * s);
}

Vec3 bitmap_color(const TextureImage& image, const Texture& texture, float s, float t) {
    const auto texel = [&](int column, int row) {
        const int x = wrap_texel(column, image.width, texture.wrap_s);
        const int y = wrap_texel(row, image.height, texture.wrap_t);
        return texel_color(image, static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                                      static_cast<std::size_t>(x));
    };
    const float centre = texture.filter == NEARLIGHT_FILTER_NEAREST ? 0.0f : 0.5f;
    const float x = reduce_coordinate(s, texture.wrap_s) * static_cast<float>(image.width) - centre;
    const float y = (1.0f - reduce_coordinate(t, texture.wrap_t)) * static_cast<float>(image.height) - centre;
    const int x0 = static_cast<int>(std::floor(x));
    const int y0 = static_cast<int>(std::floor(y));
    if (texture.filter == NEARLIGHT_FILTER_NEAREST) {
        return texel(x0, y0);
    }
    const float fx = x - static_cast<float>(x0);
    const float fy = y - static_cast<float>(y0);
    Vec3 color{0, 0, 0};
    for (int i = 0; i < 4; ++i) {
        const float wx = (i & 1) != 0 ? fx : 1.0f - fx;
        const float wy = (i & 2) != 0 ? fy : 1.0f - fy;
        color += texel(x0 + (i & 1), y0 + (i >> 1)) * (wx * wy);
    }
    return color;
}

/// The parameter that a checkerboard has at (s, t).
const Parameter& field_at(const Texture& texture, float s, float t) {
    return (s - std::floor(s) > 0.5f) == (t - std::floor(t) > 0.5f) ? texture.color0 : texture.color1;
}

/// What a texture with a cutoff makes of a number.
Vec3 cut_off(Vec3 color, const Texture& texture) {
    const float kept = color.x >= texture.cutoff ? 1.0f : 0.0f;
    return texture.cutoff > 0.0f ? Vec3{kept, kept, kept} : color;
}

Vec3 mean_color(const TextureImage& image, const Texture& texture) {
    const std::size_t count = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
    std::array<double, 3> sum{};
    for (std::size_t i = 0; i < count; ++i) {
        const Vec3 color = cut_off(texel_color(image, i), texture);
        sum[0] += static_cast<double>(color.x);
        sum[1] += static_cast<double>(color.y);
        sum[2] += static_cast<double>(color.z);
    }
    const double scale = 1.0 / std::max<double>(1.0, static_cast<double>(count));
    return {static_cast<float>(sum[0] * scale), static_cast<float>(sum[1] * scale),
            static_cast<float>(sum[2] * scale)};
}

/// combined(c, …) of all texels' colours, beginning with `start`.
template <typename Combine>
Vec3 over_texels(const TextureImage& image, const Texture& texture, Vec3 start, const Combine& combined) {
    const std::size_t count = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
    for (std::size_t i = 0; i < count; ++i) {
        start = combined(start, cut_off(texel_color(image, i), texture));
    }
    return start;
}

Vec3 min_color(const TextureImage& image, const Texture& texture) {
    constexpr float kMax = std::numeric_limits<float>::max();
    return over_texels(image, texture, {kMax, kMax, kMax}, [](Vec3 a, Vec3 b) { return min(a, b); });
}

Vec3 max_color(const TextureImage& image, const Texture& texture) {
    return over_texels(image, texture, {0, 0, 0}, [](Vec3 a, Vec3 b) { return max(a, b); });
}

/// A parameter's value times what `of_checkerboard` makes of two fields or `of_image` of a bitmap.
template <typename OfCheckerboard, typename OfImage>
Vec3 summary(const Scene& scene, const Parameter& parameter, const OfCheckerboard& of_checkerboard,
             const OfImage& of_image) {
    if (parameter.texture < 0) {
        return parameter.value;
    }
    const SceneTexture& texture = scene.textures[static_cast<std::size_t>(parameter.texture)];
    const Texture& p = texture.parameters;
    switch (p.kind) {
        case NEARLIGHT_TEXTURE_CHECKERBOARD:
            return parameter.value * of_checkerboard(p.color0, p.color1);
        case NEARLIGHT_TEXTURE_VERTEX_COLOR:
            return parameter.value;
        default:
            return parameter.value * of_image(scene.images[static_cast<std::size_t>(texture.image)], p);
    }
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
                    static_cast<float>((word >> 16u) & 255u)} /
               255.0f;
    }
    return decode_texel(word);
}

Vec3 texture_color(const Scene& scene, const SceneTexture& texture, float u, float v, Vec3 vertex_color,
                   std::array<float, 2> second_uv) {
    const Texture& p = texture.parameters;
    const bool is_second = (p.flags & NEARLIGHT_TEXTURE_SECOND_UV) != 0;
    const float x = is_second ? second_uv[0] : u;
    const float y = is_second ? second_uv[1] : v;
    const float s = p.u_scale * x + p.u_shear * y + p.u_offset;
    const float t = p.v_shear * x + p.v_scale * y + p.v_offset;
    if (p.kind == NEARLIGHT_TEXTURE_CHECKERBOARD) {
        return parameter_value(scene, field_at(p, s, t), u, v, vertex_color, second_uv);
    }
    if (p.kind == NEARLIGHT_TEXTURE_VERTEX_COLOR) {
        return vertex_color;
    }
    const Vec3 color =
        cut_off(bitmap_color(scene.images[static_cast<std::size_t>(texture.image)], p, s, t), p);
    return (p.flags & NEARLIGHT_TEXTURE_TIMES_COLOR) != 0 ? color * vertex_color : color;
}

Vec3 parameter_value(const Scene& scene, const Parameter& parameter, float u, float v, Vec3 vertex_color,
                     std::array<float, 2> second_uv) {
    return parameter.texture < 0
               ? parameter.value
               : parameter.value * texture_color(scene,
                                                 scene.textures[static_cast<std::size_t>(parameter.texture)],
                                                 u, v, vertex_color, second_uv);
}

float parameter_number(const Scene& scene, const Parameter& parameter, float u, float v, Vec3 vertex_color) {
    const Parameter unscaled{kWhite, parameter.texture};
    return parameter.texture < 0
               ? parameter.value.x
               : parameter.value.x * luminance(parameter_value(scene, unscaled, u, v, vertex_color));
}

Vec3 mean_value(const Scene& scene, const Parameter& parameter) {
    const auto mean_of_fields = [&](const Parameter& a, const Parameter& b) {
        return (mean_value(scene, a) + mean_value(scene, b)) * 0.5f;
    };
    return summary(scene, parameter, mean_of_fields, mean_color);
}

Vec3 min_value(const Scene& scene, const Parameter& parameter) {
    const auto min_of_fields = [&](const Parameter& a, const Parameter& b) {
        return min(min_value(scene, a), min_value(scene, b));
    };
    return summary(scene, parameter, min_of_fields, min_color);
}

Vec3 max_value(const Scene& scene, const Parameter& parameter) {
    const auto max_of_fields = [&](const Parameter& a, const Parameter& b) {
        return max(max_value(scene, a), max_value(scene, b));
    };
    return summary(scene, parameter, max_of_fields, max_color);
}

}  // namespace nearlight::core
