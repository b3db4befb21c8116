// SPDX-License-Identifier: Apache-2.0
// How closely a segment passes the edges of triangles. Near an edge, two correct ray casters may differ.
#pragma once

#include <span>

#include "host/base/math.h"

namespace nearlight::core {

/// The minimum distance between two segments, in double precision. [Ericson, Real-Time Collision Detection,
/// 2005, section 5.1.9]
double segment_distance(Vec3 a0, Vec3 a1, Vec3 b0, Vec3 b1);

/// The minimum distance between a segment and the edges of the triangles; infinity if there are none.
double distance_to_edges(std::span<const BvhTriangle> triangles, Vec3 from, Vec3 to);

}  // namespace nearlight::core
