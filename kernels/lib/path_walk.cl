// SPDX-License-Identifier: Apache-2.0
// Light that arrives at a point of a surface after any number of bounces, estimated by a path with next-event
// estimation and connections to VPLs.
#ifndef NEARLIGHT_LIB_PATH_WALK
#define NEARLIGHT_LIB_PATH_WALK

#include "lib/light/direct.cl"
#include "lib/material.cl"

/// The law of the radius at which the geometry term is bounded for light from a place y: max_radius /
/// 2^level, but not below min_radius. The level is the first (of GATHER_LEVELS) for which the radius is at
/// most at_unit_light / √E, where E is the luminance of the direct light at y (W/m²), so that the radius
/// follows the distance between VPLs of walks. E is a rough estimate whose random numbers are hashes of y.
/// The radius is thus a function of the place alone and does not depend on the VPLs there.
typedef struct GatherRadius {
    float max_radius;  // m
    float min_radius;  // m
    float at_unit_light;
    uint seed;
} GatherRadius;
#define GATHER_LEVELS 4u
#define GATHER_LIGHT_SAMPLES 4u

inline float gather_radius(const SceneView* scene, const GatherRadius* law, float3 y, float3 n) {
    float radius = law->max_radius;
    if (law->at_unit_light < INFINITY) {
        const uint key =
            random_uint4((uint4)(as_uint(y.x), as_uint(y.y), as_uint(y.z), law->seed ^ 0x6a7be4u)).x;
        const float light = luminance(direct_irradiance(scene, y, n, GATHER_LIGHT_SAMPLES, key));
        for (uint level = 1; level < GATHER_LEVELS && radius * sqrt(light) > law->at_unit_light; ++level) {
            radius *= 0.5f;
        }
    }
    return fmax(radius, law->min_radius);
}

/// A set of VPLs to connect to. `count` chosen ones stand for all `vpl_count`, and the geometry term of each
/// is bounded at its radius.
typedef struct Connections {
    const global Vpl* vpls;
    const global float* radii;
    uint vpl_count;
    uint count;
    GatherRadius law;
} Connections;

/// Irradiance at x from VPLs of depth up to `max_depth`, estimated from VPLs at equal distances in the set,
/// of which `u` chooses the first.
inline float3 connected_irradiance(const SceneView* scene, const Connections* to, float3 x, float3 n,
                                   uint max_depth, float u) {
    const uint count = min(to->count, to->vpl_count);
    const float step = (float)to->vpl_count / (float)count;
    float3 sum = (float3)(0.0f);
    for (uint i = 0; i < count; ++i) {
        const uint index = min((uint)(((float)i + u) * step), to->vpl_count - 1);
        const global Vpl* vpl = to->vpls + index;
        const float3 origin = load3(vpl->position);
        const float3 between = x - origin;
        const float squared = dot(between, between);
        const float cosines =
            -dot(n, between) * dot(load3(vpl->normal), between);  // times the distance squared
        if (vpl->depth <= max_depth && dot(n, between) < 0.0f && cosines > 0.0f &&
            is_visible(scene, origin, x)) {
            sum += load3(vpl->power) *
                   (cosines / (squared * fmax(squared, to->radii[index] * to->radii[index])));
        }
    }
    return count > 0 ? sum * (M_1_PI_F * step) : sum;
}

/// One-path estimate of the irradiance at x (unit normal n, off its surface) from light that took at most
/// `bounce_count` steps from its source, including the step to x. It adds up the direct light at x, VPLs for
/// farther surfaces, and short rays for near ones. As everywhere beyond the receiver, surfaces are
/// Lambertian. The VPLs supply what a geometry term bounded at their radius lets through. The remainder is (1
/// − t²/radius²) of what a cosine-distributed ray meets nearer than the radius there. It is the light of the
/// next vertex of the path and is estimated in the same way. Few paths are longer than one step.
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
        irradiance +=
            weight * connected_irradiance(scene, to, x, n, bounce_count - 1 - bounce, to_unit_float(keys.w));
        const float2 u = (float2)(to_unit_float(keys.y), to_unit_float(keys.z));
        const float3 direction = to_world_frame(square_to_cosine_hemisphere(u), n);
        const SurfaceHit hit = trace_opaque(scene, x, direction, to->law.max_radius);
        if (hit.t < 0.0f || !reflects(scene->materials + hit.material, hit.front)) {
            break;
        }
        x = offset_point(scene, hit.position, hit.geometric);
        n = hit.geometric;
        const float ratio = hit.t / gather_radius(scene, &to->law, x, n);
        weight *=
            light_albedo(scene, scene->materials + hit.material, hit.uv) * fmax(0.0f, 1.0f - ratio * ratio);
        if (is_black(weight)) {
            break;
        }
    }
    return irradiance;
}

#endif
