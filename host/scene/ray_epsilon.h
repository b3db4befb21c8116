// SPDX-License-Identifier: Apache-2.0
// How far a ray that leaves a surface starts from it. Kernels use the same formulas.
#pragma once

#include <algorithm>
#include <cmath>

#include "host/base/math.h"
#include "host/scene/scene.h"

namespace nearlight::core {

inline Vec3 magnitudes(Vec3 v) {
    return {std::abs(v.x), std::abs(v.y), std::abs(v.z)};
}

/// Distance (m) by which a point p is moved off a surface of which nothing else is known: some rounding
/// errors of its coordinates, and at least those of a point 5 % of `extent` (largest side of the scene's
/// bounds, m) from the origin.
inline float ray_epsilon(Vec3 p, float extent) {
    return 2e-5f * std::max(max_component(magnitudes(p)), 0.05f * extent);
}

/// The point p moved off its surface by ray_epsilon() along the unit geometric normal, which points to the
/// side on which the ray continues.
inline Vec3 moved_off(Vec3 p, Vec3 normal, float extent) {
    return p + normal * ray_epsilon(p, extent);
}

/// The extent that counts for a point on a round lamp of this radius (m): that of what may lie around it.
inline float extent_about(Vec3 p, float radius, float extent) {
    return std::min(extent, 40.0f * (max_component(magnitudes(p)) + radius));
}

/// Distance (m) by which rays start off the triangle a, b, c in a scene whose bounds have these sides, but no
/// more than a point beside it would be moved. Along the normal n, these errors add up in single precision:
/// - of a point on the triangle, which is a sum of its corners: that of the corners along n;
/// - of the normal, by which a point of the triangle seems to lie off its plane: that of the products of the
///   edges, times the edges;
/// - of coordinates as such, half a rounding error of the largest;
/// - of a segment that comes from the other end of the scene, or from 64 times as far away as the corners are
///   from the origin.
/// A wide floor that is level has hardly any of these, however wide it is.
inline float triangle_stand_off(Vec3 a, Vec3 b, Vec3 c, Vec3 scene_size) {
    const Vec3 edge1 = b - a;
    const Vec3 edge2 = c - a;
    const Vec3 across = cross(edge1, edge2);
    const float inverse = 1.0f / length(across);
    const Vec3 n = magnitudes(across) * inverse;
    const Vec3 magnitude = max(magnitudes(a), max(magnitudes(b), magnitudes(c)));
    const Vec3 e1 = magnitudes(edge1);
    const Vec3 e2 = magnitudes(edge2);
    const Vec3 products{e1.y * e2.z + e1.z * e2.y, e1.z * e2.x + e1.x * e2.z, e1.x * e2.y + e1.y * e2.x};
    const float largest = max_component(magnitude);
    const float rounding = 1e-6f * (dot(n, magnitude) + dot(max(e1, e2), products) * inverse) +
                           5e-8f * largest +
                           4e-7f * dot(n, min(scene_size, Vec3{1, 1, 1} * (64.0f * largest)));
    const float most = ray_epsilon(magnitude, max_component(scene_size));
    return rounding < most ? rounding : most;
}

/// The same of a triangle of the scene.
inline float triangle_stand_off(const Scene& scene, uint triangle, Vec3 scene_size) {
    const Triangle& t = scene.triangles[triangle];
    return triangle_stand_off(scene.vertices[t.v0].position, scene.vertices[t.v1].position,
                              scene.vertices[t.v2].position, scene_size);
}

}  // namespace nearlight::core
