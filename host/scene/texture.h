// SPDX-License-Identifier: Apache-2.0
// Texture lookup on the host. The kernels do the same arithmetic in the same order.
#pragma once

#include <array>
#include <cstdint>

#include "host/scene/scene.h"

namespace nearlight::core {

/// The linear value of each 8-bit sRGB code [IEC 61966-2-1]; kernels read the same table.
const std::array<float, 256>& srgb_decode_table();
/// The linear colour of a texel; alpha does not count.
Vec3 decode_texel(std::uint32_t texel);

/// The colour, linear sRGB, at the surface's texture coordinates (u, v), to which the texture's placement is
/// applied first. v = 0 is the bottom edge of the bitmap; the centre of texel i of n is at (i + 0.5)/n. The
/// lookup is bilinear between the four nearest texels and repeats in both directions. Coordinates that are
/// not finite count as 0.
Vec3 texture_color(const Scene& scene, const SceneTexture& texture, float u, float v);

}  // namespace nearlight::core
