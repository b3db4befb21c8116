// SPDX-License-Identifier: Apache-2.0
// FLIP: how different two pictures look when one flips between them.
#pragma once

#include <span>
#include <vector>

#include "kernels/shared/types.h"

namespace nearlight::core {

/// Pixels per degree of a screen that is 0.7 m away, 0.7 m wide and 3840 pixels across.
inline constexpr float kFlipPixelsPerDegree = 67.0f;

/// The LDR-FLIP error of each pixel, 0 (equal) to 1, between two pictures in linear sRGB, whose values are
/// clamped to [0, 1]. Both have width·height finite pixels, top row first. [Andersson et al., FLIP: A
/// Difference Evaluator for Alternating Images, HPG 2020]
std::vector<float> flip_error(int width, int height, std::span<const Vec3> a, std::span<const Vec3> b,
                              float pixels_per_degree = kFlipPixelsPerDegree);

}  // namespace nearlight::core
