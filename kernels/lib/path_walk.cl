// SPDX-License-Identifier: Apache-2.0
// Light that arrives at a point of a surface after any number of bounces, by a path with next-event estimation.
#ifndef NEARLIGHT_LIB_PATH_WALK
#define NEARLIGHT_LIB_PATH_WALK

#include "lib/emitter.cl"
#include "lib/material.cl"

/// One-path estimate of the irradiance at x (unit normal n, off its surface) from light that took at most
/// `bounce_count` steps from its source, the one to x included: direct light at x, and at each further vertex of a
/// cosine-distributed walk. As everywhere beyond the receiver, surfaces are Lambertian and no term is bounded.
inline float3 walk_irradiance(const SceneView* scene, float3 x, float3 n, uint bounce_count, uint direct_samples,
                              uint seed) {
    float3 irradiance = (float3)(0.0f);
    float3 weight = (float3)(1.0f);
    for (uint bounce = 0; bounce < bounce_count; ++bounce) {
        const uint4 keys = random_uint4((uint4)(bounce, seed, 0x3a1cu, 0x9a7bu));
        irradiance += weight * direct_irradiance(scene, x, n, bounce == 0 ? direct_samples : 1, keys.x);
        if (bounce + 1 == bounce_count) {
            break;
        }
        const float2 u = (float2)(to_unit_float(keys.y), to_unit_float(keys.z));
        const SurfaceHit hit = trace_opaque(scene, x, to_world_frame(square_to_cosine_hemisphere(u), n), INFINITY);
        if (hit.t < 0.0f || !reflects(scene->materials + hit.material, hit.front)) {
            break;
        }
        weight *= light_albedo(scene, scene->materials + hit.material, hit.uv);
        if (is_black(weight)) {
            break;
        }
        x = offset_point(scene, hit.position, hit.geometric);
        n = hit.geometric;
    }
    return irradiance;
}

#endif
