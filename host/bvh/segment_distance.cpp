// SPDX-License-Identifier: Apache-2.0
#include "host/bvh/segment_distance.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "host/base/vec3d.h"

namespace nearlight::core {
namespace {

/// The t in [0, 1] for which origin + t·direction is nearest to the point.
double nearest(Vec3d point, Vec3d origin, Vec3d direction) {
    const double squared = dot(direction, direction);
    return squared > 0.0 ? std::clamp(dot(point - origin, direction) / squared, 0.0, 1.0) : 0.0;
}

}  // namespace

double segment_distance(Vec3 a0, Vec3 a1, Vec3 b0, Vec3 b1) {
    const Vec3d p = as_double(a0);
    const Vec3d q = as_double(b0);
    const Vec3d d = as_double(a1) - p;
    const Vec3d e = as_double(b1) - q;
    const double dd = dot(d, d);
    const double de = dot(d, e);
    const double ee = dot(e, e);
    const Vec3d offset = p - q;
    const double determinant = dd * ee - de * de;
    double s = 0.0;
    if (determinant > 0.0) {
        s = std::clamp((de * dot(e, offset) - ee * dot(d, offset)) / determinant, 0.0, 1.0);
    }
    // Alternating projections settle the clamped cases.
    double t = nearest(p + s * d, q, e);
    s = nearest(q + t * e, p, d);
    t = nearest(p + s * d, q, e);
    return length((p + s * d) - (q + t * e));
}

double distance_to_margins(std::span<const BvhTriangle> triangles, Vec3 from, Vec3 to) {
    const Vec3d origin = as_double(from);
    const Vec3d way = as_double(to) - origin;
    double min_distance = std::numeric_limits<double>::infinity();
    for (const BvhTriangle& triangle : triangles) {
        const Vec3d edge1 = as_double(triangle.edge1);
        const Vec3d edge2 = as_double(triangle.edge2);
        const Vec3d normal = cross(edge1, edge2);
        const double fall = dot(normal, way);
        const Vec3d offset = as_double(triangle.v0) - origin;
        const double t = dot(normal, offset) / fall;
        const Vec3d across = cross(offset, way);
        const double u = dot(across, edge2) / fall;
        const double v = -dot(across, edge1) / fall;
        if (t > 0.0 && t < 1.0 && u >= 0.0 && v >= 0.0 && u + v <= 1.0) {
            const double cosine = std::abs(fall) / (length(normal) * length(way));
            min_distance = std::min({min_distance, cosine * std::abs(t - double{NEARLIGHT_SEGMENT_T_MIN}),
                                     cosine * std::abs(t - double{NEARLIGHT_SEGMENT_T_MAX})});
        }
    }
    return min_distance;
}

double distance_to_edges(std::span<const BvhTriangle> triangles, Vec3 from, Vec3 to) {
    double min_distance = std::numeric_limits<double>::infinity();
    for (const BvhTriangle& triangle : triangles) {
        const Vec3 v1 = triangle.v0 + triangle.edge1;
        const Vec3 v2 = triangle.v0 + triangle.edge2;
        min_distance =
            std::min({min_distance, segment_distance(from, to, triangle.v0, v1),
                      segment_distance(from, to, v1, v2), segment_distance(from, to, v2, triangle.v0)});
    }
    return min_distance;
}

}  // namespace nearlight::core
