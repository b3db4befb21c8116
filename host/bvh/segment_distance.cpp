// SPDX-License-Identifier: Apache-2.0
#include "host/bvh/segment_distance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace nearlight::core {
namespace {

using Vec3d = std::array<double, 3>;

Vec3d widen(Vec3 v) {
    return {v.x, v.y, v.z};
}
Vec3d minus(const Vec3d& a, const Vec3d& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
Vec3d along(const Vec3d& origin, const Vec3d& direction, double t) {
    return {origin[0] + t * direction[0], origin[1] + t * direction[1], origin[2] + t * direction[2]};
}
double dot(const Vec3d& a, const Vec3d& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
/// The t in [0, 1] for which origin + t·direction is nearest to the point.
double nearest(const Vec3d& point, const Vec3d& origin, const Vec3d& direction) {
    const double squared = dot(direction, direction);
    return squared > 0.0 ? std::clamp(dot(minus(point, origin), direction) / squared, 0.0, 1.0) : 0.0;
}

}  // namespace

double segment_distance(Vec3 a0, Vec3 a1, Vec3 b0, Vec3 b1) {
    const Vec3d p = widen(a0);
    const Vec3d q = widen(b0);
    const Vec3d d = minus(widen(a1), p);
    const Vec3d e = minus(widen(b1), q);
    const double dd = dot(d, d);
    const double de = dot(d, e);
    const double ee = dot(e, e);
    const Vec3d offset = minus(p, q);
    const double determinant = dd * ee - de * de;
    double s = 0.0;
    if (determinant > 0.0) {
        s = std::clamp((de * dot(e, offset) - ee * dot(d, offset)) / determinant, 0.0, 1.0);
    }
    // Alternating projections settle the clamped cases.
    double t = nearest(along(p, d, s), q, e);
    s = nearest(along(q, e, t), p, d);
    t = nearest(along(p, d, s), q, e);
    const Vec3d between = minus(along(p, d, s), along(q, e, t));
    return std::sqrt(dot(between, between));
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
