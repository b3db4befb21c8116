// SPDX-License-Identifier: Apache-2.0
// Which triangles reach into the close range, worked out without clipping polygons, and which points lie in
// it.
#pragma once

#include "host/base/math.h"

namespace nearlight::core {

struct TriangleCorners {
    Vec3 a, b, c;
};

/// Squared distance (m²) from the camera to the nearest point of the triangle inside the five planes of the
/// region, each moved outwards by `slack` m; infinity where there is none. The range itself is not looked at.
double nearest_squared_distance(const TriangleCorners& corners, const CloseRange& region, double slack);

/// Whether a point lies in the close range as the flag says, or so near its border (m) that rounding decides.
bool close_flag_fits(const CloseRange& region, Vec3 p, bool flag, float slack);

}  // namespace nearlight::core
