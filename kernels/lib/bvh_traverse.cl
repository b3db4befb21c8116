// SPDX-License-Identifier: Apache-2.0
// Traversal of the binary tree by one ray: any hit and closest hit.
//
// Nodes and triangles are read as rows of four floats, because a GPU takes about as long for one float as for
// four where each work-item reads somewhere else.
//
// Stack: the builder bounds the depth (NEARLIGHT_MAX_BVH_DEPTH), so the stack cannot overflow. Rays with NaN
// or infinity hit nothing (is_finite_ray()).
#ifndef NEARLIGHT_LIB_BVH_TRAVERSE
#define NEARLIGHT_LIB_BVH_TRAVERSE

#include "lib/ray.cl"

/// The boxes of a node's children, and the children.
typedef struct NodeRows {
    float4 left_min, left_max, right_min, right_max;
    uint left, right;
} NodeRows;

static inline NodeRows load_node(const global BvhNode* node) {
    const global float4* rows = (const global float4*)node;
    NodeRows loaded = {rows[0], rows[1], rows[2], rows[3], 0, 0};
    loaded.left = as_uint(loaded.left_min.w);
    loaded.right = as_uint(loaded.left_max.w);
    return loaded;
}

static inline TreeTriangle load_triangle(const global BvhTriangle* triangle) {
    const global float4* rows = (const global float4*)triangle;
    const float4 a = rows[0];
    const float4 b = rows[1];
    const float4 c = rows[2];
    const TreeTriangle loaded = {a.xyz, (float3)(a.w, b.xy), (float3)(b.zw, c.x), c.yzw};
    return loaded;
}

/// Entry distance of the ray into the box, or infinity if it misses. t_max must be finite, so that the two
/// differ.
static inline float enter_box(float3 box_min, float3 box_max, float3 origin, float3 reciprocal, float t_min,
                              float t_max) {
    const float3 t0 = (box_min - origin) * reciprocal;
    const float3 t1 = (box_max - origin) * reciprocal;
    const float3 near3 = fmin(t0, t1);
    const float3 far3 = fmax(t0, t1);
    const float t_near = fmax(fmax(near3.x, near3.y), fmax(near3.z, t_min));
    const float t_far = fmin(fmin(far3.x, far3.y), fmin(far3.z, t_max));
    return t_near <= t_far ? t_near : INFINITY;
}

/// Möller–Trumbore test of both sides of a triangle, for t strictly inside (t_min, t_max). It divides only if
/// the triangle is hit; otherwise it returns false and leaves `hit` as it is.
static inline bool hit_triangle(const global BvhTriangle* at, float3 origin, float3 direction, float t_min,
                                float t_max, RayHit* hit) {
    const TreeTriangle triangle = load_triangle(at);
    const float3 to_origin = origin - triangle.v0;
    const float determinant = -dot(direction, triangle.normal);
    const float side = copysign(1.0f, determinant);
    const float scale = fabs(determinant);
    const float3 crossed = cross(to_origin, direction);
    const float u = dot(triangle.edge2, crossed) * side;
    const float v = -dot(triangle.edge1, crossed) * side;
    const float t = dot(to_origin, triangle.normal) * side;
    if (!(scale > 0.0f) || !(u >= 0.0f) || !(v >= 0.0f) || !(u + v <= scale) || !(t > t_min * scale) ||
        !(t < t_max * scale)) {
        return false;
    }
    const float inverse = 1.0f / scale;
    hit->t = t * inverse;
    hit->u = u * inverse;
    hit->v = v * inverse;
    return true;
}

/// True if anything lies on the ray strictly inside (t_min, t_max).
static inline bool occluded(const global BvhNode* nodes, const global BvhTriangle* triangles, float3 origin,
                            float3 direction, float t_min, float t_max) {
    if (!is_finite_ray(origin, direction, t_max)) {
        return false;
    }
    t_max = fmin(t_max, FLT_MAX);
    const float3 reciprocal = safe_reciprocal(direction);
    uint stack[NEARLIGHT_MAX_BVH_DEPTH + 4];
    int top = 0;
    uint child = 0;
    RayHit ignored;
    for (;;) {
        if (child & NEARLIGHT_LEAF_BIT) {
            const uint first = child & NEARLIGHT_LEAF_FIRST_MASK;
            const uint count = ((child >> NEARLIGHT_LEAF_COUNT_SHIFT) & NEARLIGHT_LEAF_COUNT_MASK) + 1;
            for (uint i = first; i < first + count; ++i) {
                if (hit_triangle(triangles + i, origin, direction, t_min, t_max, &ignored)) {
                    return true;
                }
            }
        } else {
            const NodeRows node = load_node(nodes + child);
            const float left =
                enter_box(node.left_min.xyz, node.left_max.xyz, origin, reciprocal, t_min, t_max);
            const float right =
                enter_box(node.right_min.xyz, node.right_max.xyz, origin, reciprocal, t_min, t_max);
            const bool hits_left = left <= t_max;
            const bool hits_right = right <= t_max;
            if (hits_left && hits_right) {
                const bool left_first = left <= right;
                stack[top++] = left_first ? node.right : node.left;
                child = left_first ? node.left : node.right;
                continue;
            }
            if (hits_left || hits_right) {
                child = hits_left ? node.left : node.right;
                continue;
            }
        }
        if (top == 0) {
            return false;
        }
        child = stack[--top];
    }
}

/// The closest hit strictly inside (t_min, t_max). Its slot is ~0u if nothing is hit.
static inline RayHit closest_hit(const global BvhNode* nodes, const global BvhTriangle* triangles,
                                 float3 origin, float3 direction, float t_min, float t_max) {
    RayHit best = {fmin(t_max, FLT_MAX), 0.0f, 0.0f, ~0u};
    if (!is_finite_ray(origin, direction, t_max)) {
        return best;
    }
    const float3 reciprocal = safe_reciprocal(direction);
    uint stack[NEARLIGHT_MAX_BVH_DEPTH + 4];
    float entry[NEARLIGHT_MAX_BVH_DEPTH + 4];
    int top = 0;
    uint child = 0;
    for (;;) {
        if (child & NEARLIGHT_LEAF_BIT) {
            const uint first = child & NEARLIGHT_LEAF_FIRST_MASK;
            const uint count = ((child >> NEARLIGHT_LEAF_COUNT_SHIFT) & NEARLIGHT_LEAF_COUNT_MASK) + 1;
            for (uint i = first; i < first + count; ++i) {
                if (hit_triangle(triangles + i, origin, direction, t_min, best.t, &best)) {
                    best.slot = i;
                }
            }
        } else {
            const NodeRows node = load_node(nodes + child);
            const float left =
                enter_box(node.left_min.xyz, node.left_max.xyz, origin, reciprocal, t_min, best.t);
            const float right =
                enter_box(node.right_min.xyz, node.right_max.xyz, origin, reciprocal, t_min, best.t);
            const bool hits_left = left <= best.t;
            const bool hits_right = right <= best.t;
            if (hits_left && hits_right) {
                const bool left_first = left <= right;
                stack[top] = left_first ? node.right : node.left;
                entry[top++] = left_first ? right : left;
                child = left_first ? node.left : node.right;
                continue;
            }
            if (hits_left || hits_right) {
                child = hits_left ? node.left : node.right;
                continue;
            }
        }
        do {
            if (top == 0) {
                return best;
            }
            child = stack[--top];
        } while (entry[top] > best.t);
    }
}

#endif
