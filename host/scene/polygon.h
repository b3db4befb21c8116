// SPDX-License-Identifier: Apache-2.0
// Division of polygons into triangles.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "host/base/math.h"

namespace nearlight::core {

/// Polygons with more corners that are not convex become fans, because cutting ears takes a time in
/// proportion to the square of their number.
inline constexpr std::size_t kMaxEarCorners = 10'000;

/// Whether the corners, seen along the polygon's mean normal [Newell], turn to one side only. Polygons
/// without an area count as convex.
bool is_convex(std::span<const Vec3> corners);

/// The triangles of a polygon of at least three corners, as indices of corners, which run as the polygon's: a
/// fan from the first corner if it is convex or has more than kMaxEarCorners, otherwise ears that are cut off
/// one by one [Meisters 1975]. Always two less than there are corners. Polygons that cross themselves get
/// some division.
std::vector<std::array<uint, 3>> triangulate(std::span<const Vec3> corners);

}  // namespace nearlight::core
