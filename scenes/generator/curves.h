// SPDX-License-Identifier: Apache-2.0
// Curves in space, and profiles for the lathe.
#pragma once

#include <span>
#include <vector>

#include "host/base/math.h"

namespace nearlight::core::scenes {

using Curve = std::vector<Vec3>;
/// Points (radius, height, 0) from the bottom of the axis along the outside and back to the axis.
using Profile = std::vector<Vec3>;

inline Vec3 at(float radius, float height) {
    return {radius, height, 0.0f};
}

/// Catmull-Rom spline through all points, with `steps` segments from each point to the next.
Curve spline(std::span<const Vec3> points, int steps);
/// The polyline with each inner corner rounded off, starting at most `radius` before it.
Curve rounded(std::span<const Vec3> points, float radius, int steps = 4);
/// Profile of an open vessel: `outside` runs from the foot to the lip; the wall has even thickness and the
/// lip is round.
Profile vessel(std::span<const Vec3> outside, float thickness, int steps = 10);
/// Profile of a solid of revolution from its corners, which are bevelled. It begins and ends at the axis.
Profile solid(std::span<const Vec3> corners, float bevel);

}  // namespace nearlight::core::scenes
