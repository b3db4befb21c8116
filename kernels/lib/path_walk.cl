// SPDX-License-Identifier: Apache-2.0
// Light that arrives at a point of a surface after any number of bounces, by a path with next-event estimation and
// connections to VPLs.
#ifndef NEARLIGHT_LIB_PATH_WALK
#define NEARLIGHT_LIB_PATH_WALK

#include "lib/emitter.cl"
#include "lib/material.cl"

/// A set of VPLs to connect to: so many chosen ones stand for all, and the geometry term is bounded at `radius`.
typedef struct Connections {
    const global Vpl* vpls;
    uint vpl_count;
    uint count;
    float radius;
} Connections;

/// Irradiance at x from VPLs of depth up to `deepest`, estimated from an even choice among them from a random one on.
inline float3 connected_irradiance(const SceneView* scene, const Connections* to, float3 x, float3 n, uint deepest,
                                   float u) {
    const uint count = min(to->count, to->vpl_count);
    const float step = (float)to->vpl_count / (float)count;
    float3 sum = (float3)(0.0f);
    for (uint i = 0; i < count; ++i) {
        const global Vpl* vpl = to->vpls + min((uint)(((float)i + u) * step), to->vpl_count - 1);
        const float3 origin = load3(vpl->position);
        const float3 between = x - origin;
        const float squared = dot(between, between);
        const float cosines = -dot(n, between) * dot(load3(vpl->normal), between);  // times the distance squared
        if (vpl->depth <= deepest && dot(n, between) < 0.0f && cosines > 0.0f && is_visible(scene, origin, x)) {
            sum += load3(vpl->power) * (cosines / (squared * fmax(squared, to->radius * to->radius)));
        }
    }
    return count > 0 ? sum * (M_1_PI_F * step) : sum;
}

/// One-path estimate of the irradiance at x (unit normal n, off its surface) from light that took at most
/// `bounce_count` steps from its source, the one to x included: direct light at x, VPLs for farther surfaces, and short
/// rays for near ones. As everywhere beyond the receiver, surfaces are Lambertian. The VPLs bring what a geometry term
/// bounded at the radius lets through, and the remainder, (1 − t²/radius²) of what a cosine-distributed ray meets nearer
/// than that, is the light of a next vertex, made in the same way. Hardly a path is longer than a step.
inline float3 short_walk_irradiance(const SceneView* scene, const Connections* to, float3 x, float3 n,
                                    uint bounce_count, uint direct_samples, uint seed) {
    float3 irradiance = (float3)(0.0f);
    float3 weight = (float3)(1.0f);
    for (uint bounce = 0; bounce < bounce_count; ++bounce) {
        const uint4 keys = random_uint4((uint4)(bounce, seed, 0x3a1du, 0x9a7bu));
        irradiance += weight * direct_irradiance(scene, x, n, bounce == 0 ? direct_samples : 1, keys.x);
        if (bounce + 1 == bounce_count) {
            break;
        }
        irradiance += weight * connected_irradiance(scene, to, x, n, bounce_count - 1 - bounce, to_unit_float(keys.w));
        const float2 u = (float2)(to_unit_float(keys.y), to_unit_float(keys.z));
        const SurfaceHit hit = trace_opaque(scene, x, to_world_frame(square_to_cosine_hemisphere(u), n), to->radius);
        if (hit.t < 0.0f || !reflects(scene->materials + hit.material, hit.front)) {
            break;
        }
        const float ratio = hit.t / to->radius;
        weight *= light_albedo(scene, scene->materials + hit.material, hit.uv) * fmax(0.0f, 1.0f - ratio * ratio);
        if (is_black(weight)) {
            break;
        }
        x = offset_point(scene, hit.position, hit.geometric);
        n = hit.geometric;
    }
    return irradiance;
}

#endif
