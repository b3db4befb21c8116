// SPDX-License-Identifier: Apache-2.0
// Texture lookup on the host. kernels/lib/texture.cl does the same arithmetic in the same order.
#pragma once

#include <array>
#include <cstdint>

#include "host/scene/scene.h"

namespace nearlight::core {

/// The linear value of each 8-bit sRGB code [IEC 61966-2-1]; kernels read the same table.
const std::array<float, 256>& srgb_decode_table();
/// The linear colour of an sRGB-encoded texel of 8 bits a channel; alpha does not count.
Vec3 decode_texel(std::uint32_t texel);
/// The linear colour of the texel with the index row·width + column.
Vec3 texel_color(const TextureImage& image, std::size_t texel);

inline constexpr Vec3 kWhite{1, 1, 1};

/// The value of a parameter at the surface's texture coordinates (u, v): its number or colour times its
/// texture, where it has one. `vertex_color` is the interpolated colour of the vertices, `second_uv` are
/// their second texture coordinates.
Vec3 parameter_value(const Scene& scene, const Parameter& parameter, float u, float v,
                     Vec3 vertex_color = kWhite, std::array<float, 2> second_uv = {0, 0});

/// The value of a parameter that is a number, which takes from a texture the luminance of its colour.
float parameter_number(const Scene& scene, const Parameter& parameter, float u, float v,
                       Vec3 vertex_color = kWhite);

/// What a texture says at (u, v), linear sRGB. The texture's placement is applied first. v = 0 is the bottom
/// edge of the bitmap; the centre of texel i of n is at (i + 0.5)/n. Coordinates that are not finite count
/// as 0.
Vec3 texture_color(const Scene& scene, const SceneTexture& texture, float u, float v,
                   Vec3 vertex_color = kWhite, std::array<float, 2> second_uv = {0, 0});

/// An estimate of the mean of a parameter over its textures, where the vertices' colours count as white.
Vec3 mean_value(const Scene& scene, const Parameter& parameter);
/// The smallest and the largest value of each channel of a parameter over its textures, where the vertices'
/// colours count as white.
Vec3 min_value(const Scene& scene, const Parameter& parameter);
Vec3 max_value(const Scene& scene, const Parameter& parameter);

}  // namespace nearlight::core
