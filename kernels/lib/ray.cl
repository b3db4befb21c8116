// SPDX-License-Identifier: Apache-2.0
// What traversals share. Directions are kept away from zero, so that slab tests meet no 0·∞.
#ifndef NEARLIGHT_LIB_RAY
#define NEARLIGHT_LIB_RAY

#include "lib/math.cl"

inline float away_from_zero(float x) {
    return fabs(x) < 1e-20f ? copysign(1e-20f, x) : x;
}
inline float3 safe_reciprocal(float3 d) {
    return (float3)(1.0f / away_from_zero(d.x), 1.0f / away_from_zero(d.y), 1.0f / away_from_zero(d.z));
}

/// A ray with NaN or infinity in it (other than an infinite t_max) hits nothing; without this test it would
/// visit every node, for fmin and fmax pass over NaN.
inline bool is_finite_ray(float3 origin, float3 direction, float t_max) {
    return isfinite(origin.x + origin.y + origin.z + direction.x + direction.y + direction.z) &&
           !isnan(t_max);
}

#endif
