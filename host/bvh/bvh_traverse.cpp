// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>

#include "host/bvh/bvh.h"
#include "host/bvh/ray_tests.h"
#include "host/bvh/sah_builder.h"

namespace nearlight::core {
namespace {

/// `hit.t` is t_max on entry. If `any` is true, the first hit found ends the traversal.
template <bool any>
bool traverse(const Bvh& bvh, const TestRay& ray, BvhHit& hit) {
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
    const TestRay ray = make_test_ray(origin, direction, t_min);
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

}  // namespace nearlight::core
