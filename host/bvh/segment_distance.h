// SPDX-License-Identifier: Apache-2.0
// How closely a segment passes the edges of triangles, or meets one at its end. Near an edge, two correct ray
// casters may differ, and so they may about what a segment meets just where its margin begins.
#pragma once

#include <span>

#include "host/base/math.h"

namespace nearlight::core {

/// The minimum distance between two segments, in double precision. [Ericson, Real-Time Collision Detection,
/// 2005, section 5.1.9]
double segment_distance(Vec3 a0, Vec3 a1, Vec3 b0, Vec3 b1);

/// The minimum distance between a segment and the edges of the triangles; infinity if there are none.
double distance_to_edges(std::span<const BvhTriangle> triangles, Vec3 from, Vec3 to);

/// How closely the segment meets a triangle at the beginning of one of its margins, NEARLIGHT_SEGMENT_T_MIN
/// or _MAX of its way: the distance from there to the triangle's plane ÷ the segment's length, in double
/// precision; the minimum over the triangles that it meets, and infinity if there are none.
double distance_to_margins(std::span<const BvhTriangle> triangles, Vec3 from, Vec3 to);

}  // namespace nearlight::core
