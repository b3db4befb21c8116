// SPDX-License-Identifier: Apache-2.0
// Traversal of the wide tree by one ray, for CPUs: any hit and closest hit, with the eight boxes of a node in
// one vector and the four triangles of a block in another. It finds what lib/bvh_traverse.cl finds, bit by
// bit, except for rays that meet two triangles at the same distance. Copies of its two functions wherever a
// ray is traced would be no faster, but take longer to compile.
//
// Stack: a path has at most NEARLIGHT_MAX_BVH_DEPTH nodes, each of which leaves all of its children but one.
#ifndef NEARLIGHT_LIB_WIDE_RAY
#define NEARLIGHT_LIB_WIDE_RAY

#include "lib/outlined.cl"
#include "lib/ray.cl"
#include "lib/wide_tree.cl"

#if NEARLIGHT_WIDE_RAYS

#define WIDE_RAY_STACK_SIZE ((NEARLIGHT_WIDE_CHILDREN - 1) * NEARLIGHT_MAX_BVH_DEPTH + 1)

typedef struct WideRay {
    float3 origin, direction;
    float3 by;     // reciprocals of the direction's components, neither 0 nor infinite
    uint near[3];  // floats from a plane of a node's `low` to the one where the ray enters
    float t_min;
} WideRay;

LANES_INLINE WideRay make_wide_ray(float3 origin, float3 direction, float t_min) {
    WideRay ray;
    ray.origin = origin;
    ray.direction = direction;
    // A reciprocal of 0 would turn the infinite planes of missing children into NaN.
    ray.by = safe_reciprocal(clamp(direction, -1e37f, 1e37f));
    ray.near[0] = ray.by.x < 0.0f ? WIDE_UPPER : 0;
    ray.near[1] = ray.by.y < 0.0f ? WIDE_UPPER : 0;
    ray.near[2] = ray.by.z < 0.0f ? WIDE_UPPER : 0;
    ray.t_min = t_min;
    return ray;
}

/// One bit for each child whose box the ray meets before t_max. `enter` gets the distances at which it enters
/// the boxes.
LANES_INLINE uint children_on_ray(const WideRay* ray, const global WideNode* node, float t_max,
                                  float8* enter) {
    const global float* x = node->low[0] + ray->near[0];
    const global float* y = node->low[1] + ray->near[1];
    const global float* z = node->low[2] + ray->near[2];
    const global float* far_x = node->low[0] + (WIDE_UPPER - ray->near[0]);
    const global float* far_y = node->low[1] + (WIDE_UPPER - ray->near[1]);
    const global float* far_z = node->low[2] + (WIDE_UPPER - ray->near[2]);
    const float8 x0 = (vload8(0, x) - ray->origin.x) * ray->by.x;
    const float8 y0 = (vload8(0, y) - ray->origin.y) * ray->by.y;
    const float8 z0 = (vload8(0, z) - ray->origin.z) * ray->by.z;
    const float8 x1 = (vload8(0, far_x) - ray->origin.x) * ray->by.x;
    const float8 y1 = (vload8(0, far_y) - ray->origin.y) * ray->by.y;
    const float8 z1 = (vload8(0, far_z) - ray->origin.z) * ray->by.z;
    *enter = max8(max8(x0, y0), max8(z0, (float8)ray->t_min));
    return lane_bits8(*enter <= min8(min8(x1, y1), min8(z1, (float8)t_max)));
}

// The next two functions compute what dot() and cross() of one vector do, without fused operations.
LANES_INLINE float4 plain_dot4(Axis4 a, Axis4 b) {
#pragma OPENCL FP_CONTRACT OFF
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

LANES_INLINE Axis4 plain_cross4(Axis4 a, Axis4 b) {
#pragma OPENCL FP_CONTRACT OFF
    const Axis4 axis = {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
    return axis;
}

/// What hit_triangle() computes before it divides, for each of four triangles.
typedef struct BlockHit {
    float4 scale, t, u, v;
} BlockHit;

/// One bit for each triangle of the block that the ray hits.
LANES_INLINE uint hit_block(const global TriangleBlock* block, const WideRay* ray, float t_max,
                            BlockHit* hit) {
    const Axis4 edge1 = load_axis(block->edge1[0]);
    const Axis4 edge2 = load_axis(block->edge2[0]);
    const Axis4 v0 = load_axis(block->v0[0]);
    const Axis4 normal = plain_cross4(edge1, edge2);
    const Axis4 direction = {(float4)ray->direction.x, (float4)ray->direction.y, (float4)ray->direction.z};
    const Axis4 to_origin = {ray->origin.x - v0.x, ray->origin.y - v0.y, ray->origin.z - v0.z};
    const float4 determinant = -plain_dot4(direction, normal);
    const float4 side = copysign((float4)1.0f, determinant);
    const Axis4 crossed = plain_cross4(to_origin, direction);
    hit->scale = fabs(determinant);
    hit->u = plain_dot4(edge2, crossed) * side;
    hit->v = -plain_dot4(edge1, crossed) * side;
    hit->t = plain_dot4(to_origin, normal) * side;
    return lane_bits4((hit->scale > 0.0f) & (hit->u >= 0.0f) & (hit->v >= 0.0f) &
                      (hit->u + hit->v <= hit->scale) & (hit->t > ray->t_min * hit->scale) &
                      (hit->t < t_max * hit->scale));
}

LANES_INLINE bool leaf_occludes(const global TriangleBlock* blocks, uint leaf, const WideRay* ray,
                                float t_max) {
    BlockHit ignored;
    for (uint block = first_block(leaf); block <= last_block(leaf); ++block) {
        if (hit_block(blocks + block, ray, t_max, &ignored) != 0) {
            return true;
        }
    }
    return false;
}

/// True if anything lies on the ray strictly inside (t_min, t_max).
OUTLINED bool wide_occluded(const global WideNode* nodes, const global TriangleBlock* blocks, float3 origin,
                            float3 direction, float t_min, float t_max) {
    if (!is_finite_ray(origin, direction, t_max)) {
        return false;
    }
    t_max = fmin(t_max, FLT_MAX);
    const WideRay ray = make_wide_ray(origin, direction, t_min);
    uint stack[WIDE_RAY_STACK_SIZE];
    uint top = 0;
    uint child = 0;
    float8 ignored;
    for (;;) {
        if ((child & NEARLIGHT_LEAF_BIT) == 0) {
            const global WideNode* node = nodes + child;
            uint met = children_on_ray(&ray, node, t_max, &ignored);
            if (met != 0) {
                // The last child is the largest, which is likeliest to occlude.
                child = node->child[lowest_bit(met)];
                for (met &= met - 1; met != 0; met &= met - 1) {
                    stack[top++] = child;
                    child = node->child[lowest_bit(met)];
                    prefetch_child(nodes, blocks, child);
                }
                continue;
            }
        } else if (leaf_occludes(blocks, child, &ray, t_max)) {
            return true;
        }
        if (top == 0) {
            return false;
        }
        child = stack[--top];
    }
}

/// Updates `best` with each hit in a leaf that is nearer, one after the other.
LANES_INLINE void keep_nearest(const global TriangleBlock* blocks, uint leaf, const WideRay* ray,
                               RayHit* best) {
    BlockHit hit;
    for (uint block = first_block(leaf); block <= last_block(leaf); ++block) {
        for (uint met = hit_block(blocks + block, ray, best->t, &hit); met != 0; met &= met - 1) {
            const uint column = lowest_bit(met);
            const float scale = ((const float*)&hit.scale)[column];
            const float t = ((const float*)&hit.t)[column];
            if (t < best->t * scale) {
                const float inverse = 1.0f / scale;
                best->t = t * inverse;
                best->u = ((const float*)&hit.u)[column] * inverse;
                best->v = ((const float*)&hit.v)[column] * inverse;
                best->slot = block * NEARLIGHT_BLOCK_TRIANGLES + column;
            }
        }
    }
}

/// A child to be visited, with its distance in the upper half, so that the nearest child is the smallest
/// number.
typedef ulong RayVisit;
LANES_INLINE RayVisit make_visit(float enter, uint child) {
    return (ulong)as_uint(enter) << 32 | child;
}
LANES_INLINE float enter_of(RayVisit visit) {
    return as_float((uint)(visit >> 32));
}

/// The nearest child of those in `met`, which must not be 0. The others are pushed onto the stack, the
/// nearest of them last.
LANES_INLINE uint take_nearest(RayVisit* stack, uint* top, const global WideNode* nodes,
                               const global TriangleBlock* blocks, const global WideNode* node, uint met,
                               const float8* enter) {
    const float* enters = (const float*)enter;
    const uint slot = lowest_bit(met);
    met &= met - 1;
    if (met == 0) {
        return node->child[slot];
    }
    prefetch_child(nodes, blocks, node->child[slot]);
    RayVisit nearest = make_visit(enters[slot], node->child[slot]);
    const uint base = *top;
    for (; met != 0; met &= met - 1) {
        const uint other_slot = lowest_bit(met);
        prefetch_child(nodes, blocks, node->child[other_slot]);
        const RayVisit other = make_visit(enters[other_slot], node->child[other_slot]);
        const RayVisit farther = max(nearest, other);
        nearest = min(nearest, other);
        uint at = (*top)++;
        for (; at > base && stack[at - 1] < farther; --at) {
            stack[at] = stack[at - 1];
        }
        stack[at] = farther;
    }
    return (uint)nearest;
}

/// The closest hit strictly inside (t_min, t_max). Its slot is 4 · block + column, or ~0u if nothing is hit.
OUTLINED RayHit wide_closest_hit(const global WideNode* nodes, const global TriangleBlock* blocks,
                                 float3 origin, float3 direction, float t_min, float t_max) {
    RayHit best = {fmin(t_max, FLT_MAX), 0.0f, 0.0f, ~0u};
    if (!is_finite_ray(origin, direction, t_max)) {
        return best;
    }
    const WideRay ray = make_wide_ray(origin, direction, t_min);
    RayVisit stack[WIDE_RAY_STACK_SIZE];
    uint top = 0;
    uint child = 0;
    float8 enter;
    for (;;) {
        if ((child & NEARLIGHT_LEAF_BIT) == 0) {
            const global WideNode* node = nodes + child;
            const uint met = children_on_ray(&ray, node, best.t, &enter);
            if (met != 0) {
                child = take_nearest(stack, &top, nodes, blocks, node, met, &enter);
                continue;
            }
        } else {
            keep_nearest(blocks, child, &ray, &best);
        }
        RayVisit visit;
        do {
            if (top == 0) {
                return best;
            }
            visit = stack[--top];
        } while (enter_of(visit) > best.t);
        child = (uint)visit;
    }
}

#endif
#endif
