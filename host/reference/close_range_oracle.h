// SPDX-License-Identifier: Apache-2.0
// The oracle of the close range: which triangles reach into it, found without clipping polygons, and which
// points lie in it.
#pragma once

#include "host/base/math.h"

namespace nearlight::core {

struct TriangleCorners {
    Vec3 a, b, c;
};

/// Squared distance (m²) from the camera to the nearest point of the triangle inside the five planes of the
/// region, each moved outwards by `slack` m; infinity where no such point exists. The range itself plays no
/// part.
double nearest_squared_distance(const TriangleCorners& corners, const CloseRange& region, double slack);

/// The fraction of the triangle's area inside the five planes of the region and the plane that faces the
/// camera at its range, each moved outwards by `slack` m.
double part_between_planes(const TriangleCorners& corners, const CloseRange& region, double slack);

/// Whether `flag` says correctly if the point lies in the close range. Within `slack` m of the border, where
/// rounding decides, both answers are correct.
bool close_flag_fits(const CloseRange& region, Vec3 p, bool flag, float slack);

}  // namespace nearlight::core
