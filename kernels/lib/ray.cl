// SPDX-License-Identifier: Apache-2.0
// What the traversals share. Components of directions are kept away from zero, so that slab tests meet no
// 0·∞.
#ifndef NEARLIGHT_LIB_RAY
#define NEARLIGHT_LIB_RAY

#include "lib/math.cl"

/// A triangle of a tree. Its normal is edge1 × edge2, not normalised.
typedef struct TreeTriangle {
    float3 v0, edge1, edge2, normal;
} TreeTriangle;

static inline float away_from_zero(float x) {
    return fabs(x) < 1e-20f ? copysign(1e-20f, x) : x;
}
static inline float3 safe_reciprocal(float3 d) {
    return (float3)(1.0f / away_from_zero(d.x), 1.0f / away_from_zero(d.y), 1.0f / away_from_zero(d.z));
}

/// Whether a ray is free of NaN and infinity, except that t_max may be infinite. A ray that is not hits
/// nothing; without this test it would visit every node, because fmin and fmax ignore NaN.
static inline bool is_finite_ray(float3 origin, float3 direction, float t_max) {
    return isfinite(origin.x + origin.y + origin.z + direction.x + direction.y + direction.z) &&
           !isnan(t_max);
}

#endif
