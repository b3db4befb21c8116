// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>

#include "host/bvh/bvh.h"
#include "host/bvh/sah_builder.h"

namespace nearlight {
namespace {

struct Ray {
    Vec3 origin;
    Vec3 direction;
    Vec3 inverse;
    float t_min;
};

/// Keeps the reciprocal finite, so that no product with it is not-a-number.
float safe_inverse(float d) {
    return 1.0f / (std::abs(d) < 1e-20f ? std::copysign(1e-20f, d) : d);
}

/// Distance at which the ray enters the box, or infinity where it misses it within (t_min, t_max). The far
/// end is moved out by three roundings on each side, which no hit survives without [Ize, Robust BVH Ray
/// Traversal, JCGT 2013].
float enter_box(const Ray& ray, float t_max, Vec3 low, Vec3 high) {
    constexpr float kOutwards = 1.0f + 6.0f * 0x1p-24f;
    const Vec3 a = (low - ray.origin) * ray.inverse;
    const Vec3 b = (high - ray.origin) * ray.inverse;
    const Vec3 near = min(a, b);
    const Vec3 far = max(a, b) * kOutwards;
    const float t_near = std::max(max_component(near), ray.t_min);
    const float t_far = std::min(std::min(far.x, std::min(far.y, far.z)), t_max);
    return t_near <= t_far ? t_near : std::numeric_limits<float>::infinity();
}

/// Möller and Trumbore's test with the normal at hand, both sides; a hit in (t_min, hit.t) replaces `hit`.
/// Comparisons are put so that not-a-number misses.
bool intersect(const BvhTriangle& triangle, const Ray& ray, BvhHit& hit) {
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

/// `hit.t` is t_max on entry. Any: the first hit found ends it.
template <bool any>
bool traverse(const Bvh& bvh, const Ray& ray, BvhHit& hit) {
    std::array<uint, NEARLIGHT_MAX_BVH_DEPTH> stack;
    std::size_t stack_size = 0;
    uint current = 0;
    bool found = false;
    while (true) {
        if (is_leaf(current)) {
            for (uint i = leaf_first(current); i < leaf_first(current) + leaf_count(current); ++i) {
                if (intersect(bvh.triangles[i], ray, hit)) {
                    hit.triangle = bvh.triangle_ids[i];
                    found = true;
                    if constexpr (any) {
                        return true;
                    }
                }
            }
        } else {
            const BvhNode& node = bvh.nodes[current];
            const float left = enter_box(ray, hit.t, node.left_min, node.left_max);
            const float right = enter_box(ray, hit.t, node.right_min, node.right_max);
            const bool left_first = left <= right;
            if (!std::isinf(std::min(left, right))) {
                if (!std::isinf(std::max(left, right))) {
                    stack[stack_size++] = left_first ? node.right : node.left;
                }
                current = left_first ? node.left : node.right;
                continue;
            }
        }
        if (stack_size == 0) {
            return found;
        }
        current = stack[--stack_size];
    }
}

template <bool any>
BvhHit trace(const Bvh& bvh, Vec3 origin, Vec3 direction, float t_min, float t_max) {
    BvhHit hit;
    const Ray ray{origin,
                  direction,
                  {safe_inverse(direction.x), safe_inverse(direction.y), safe_inverse(direction.z)},
                  t_min};
    hit.t = t_max;
    if (!is_finite(origin) || !is_finite(direction) || !traverse<any>(bvh, ray, hit)) {
        return {};
    }
    return hit;
}

}  // namespace

BvhHit closest_hit(const Bvh& bvh, Vec3 origin, Vec3 direction, float t_min, float t_max) {
    return trace<false>(bvh, origin, direction, t_min, t_max);
}

bool occluded(const Bvh& bvh, Vec3 origin, Vec3 direction, float t_min, float t_max) {
    return trace<true>(bvh, origin, direction, t_min, t_max).triangle != ~0u;
}

}  // namespace nearlight
