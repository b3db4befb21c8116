// SPDX-License-Identifier: Apache-2.0
// Intersection of a ray with a box and with a triangle, on the host.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "host/bvh/bvh.h"

namespace nearlight::core {

struct TestRay {
    Vec3 origin;
    Vec3 direction;
    Vec3 inverse;  ///< reciprocals of the direction's components, finite
    float t_min;
};

/// Makes a ray whose reciprocals are finite, so that no product with them is not-a-number.
inline TestRay make_test_ray(Vec3 origin, Vec3 direction, float t_min) {
    const auto inverse = [](float d) { return 1.0f / (std::abs(d) < 1e-20f ? std::copysign(1e-20f, d) : d); };
    return {origin, direction, {inverse(direction.x), inverse(direction.y), inverse(direction.z)}, t_min};
}

/// The distance at which the ray enters the box, or infinity if it misses the box within (t_min, t_max). The
/// far end is moved outwards by three roundings on each side, so that no hit is lost [Ize, Robust BVH Ray
/// Traversal, JCGT 2013].
inline float enter_box(const TestRay& ray, float t_max, Vec3 low, Vec3 high) {
    constexpr float kOutwards = 1.0f + 6.0f * 0x1p-24f;
    const Vec3 a = (low - ray.origin) * ray.inverse;
    const Vec3 b = (high - ray.origin) * ray.inverse;
    const Vec3 near = min(a, b);
    const Vec3 far = max(a, b) * kOutwards;
    const float t_near = std::max(max_component(near), ray.t_min);
    const float t_far = std::min(std::min(far.x, std::min(far.y, far.z)), t_max);
    return t_near <= t_far ? t_near : std::numeric_limits<float>::infinity();
}

/// Möller and Trumbore's test with a stored normal, for both sides. A hit in (t_min, hit.t) replaces t, u and
/// v. Comparisons are written so that not-a-number misses.
inline bool intersect(const BvhTriangle& triangle, const TestRay& ray, BvhHit& hit) {
    const float det = dot(ray.direction, triangle.normal);
    if (det == 0.0f) {
        return false;
    }
    const float inverse = 1.0f / det;
    const Vec3 c = triangle.v0 - ray.origin;
    const Vec3 r = cross(c, ray.direction);
    const float u = dot(r, triangle.edge2) * inverse;
    const float v = -dot(r, triangle.edge1) * inverse;
    const float t = dot(c, triangle.normal) * inverse;
    if (!(u >= 0.0f && v >= 0.0f && u + v <= 1.0f && t > ray.t_min && t < hit.t)) {
        return false;
    }
    hit.t = t;
    hit.u = u;
    hit.v = v;
    return true;
}

}  // namespace nearlight::core
