// SPDX-License-Identifier: Apache-2.0
#include "host/scene/texture.h"

#include <cmath>

namespace nearlight::core {
namespace {

/// The part of x above its floor, in [0, 1]; rounding gives 1 for a tiny negative x. 0 if x is not finite.
float fraction(float x) {
    return std::isfinite(x) ? x - std::floor(x) : 0.0f;
}

/// Wraps i, which is from −1 to n, into 0 to n − 1.
int wrap(int i, int n) {
    return i < 0 ? i + n : (i >= n ? i - n : i);
}

Vec3 checkerboard(const Texture& texture, float s, float t) {
    return (s < 0.5f) == (t < 0.5f) ? texture.color0 : texture.color1;
}

Vec3 mix(Vec3 a, Vec3 b, float weight) {
    return a * (1.0f - weight) + b * weight;
}

Vec3 bilinear(const TextureImage& image, float s, float t) {
    const float x = s * static_cast<float>(image.width) - 0.5f;
    const float y = (1.0f - t) * static_cast<float>(image.height) - 0.5f;
    const float left = std::floor(x);
    const float top = std::floor(y);
    const int x0 = wrap(static_cast<int>(left), image.width);
    const int x1 = wrap(static_cast<int>(left) + 1, image.width);
    const int y0 = wrap(static_cast<int>(top), image.height);
    const int y1 = wrap(static_cast<int>(top) + 1, image.height);
    const auto texel = [&](int column, int row) {
        return decode_texel(
            image.texels[static_cast<std::size_t>(row) * static_cast<std::size_t>(image.width) +
                         static_cast<std::size_t>(column)]);
    };
    return mix(mix(texel(x0, y0), texel(x1, y0), x - left), mix(texel(x0, y1), texel(x1, y1), x - left),
               y - top);
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

Vec3 texture_color(const Scene& scene, const SceneTexture& texture, float u, float v) {
    const Texture& p = texture.parameters;
    const float s = fraction(p.u_scale * u + p.u_shear * v + p.u_offset);
    const float t = fraction(p.v_shear * u + p.v_scale * v + p.v_offset);
    if (p.kind == NEARLIGHT_TEXTURE_CHECKERBOARD) {
        return checkerboard(p, s, t);
    }
    return bilinear(scene.images[static_cast<std::size_t>(texture.image)], s, t);
}

}  // namespace nearlight::core
