// SPDX-License-Identifier: Apache-2.0
// Light that arrives at a point of a surface after any number of bounces, estimated by a path with next-event
// estimation and connections to VPLs.
#ifndef NEARLIGHT_LIB_PATH_WALK
#define NEARLIGHT_LIB_PATH_WALK

#include "lib/outlined.cl"
#include "lib/receiver_path.cl"
#include "lib/vpl.cl"
#include "shared/local_lights.h"

#define GATHER_LEVELS 4u         // levels of the radius
#define GATHER_LIGHT_SAMPLES 4u  // light samples by which a place estimates its direct light

/// The radius (m) by this law at a place y with the normal n, off its surface.
OUTLINED_ON_CPU float gather_radius(const SceneView* scene, const GatherRadius* law, float3 y, float3 n) {
    float radius = law->max_radius;
    if (law->at_unit_light < INFINITY) {
        const uint key =
            random_uint4((uint4)(as_uint(y.x), as_uint(y.y), as_uint(y.z), law->seed ^ 0x6a7be4u)).x;
        const ReceiverPoint at = {y, n, (float3)(0.0f), 0};
        const LightQuota quota = {.samples = GATHER_LIGHT_SAMPLES};
        const float light = luminance(sampled_direct_light(scene, &at, &quota, key));
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

/// Irradiance of a receiver from VPLs of depth up to `max_depth`, estimated from VPLs at equal distances in
/// the set; `u` chooses the first of them.
static inline float3 connected_irradiance(const SceneView* scene, const Connections* to,
                                          const ReceiverPoint* at, uint max_depth, float u) {
    const uint count = min(to->count, to->vpl_count);
    const float step = (float)to->vpl_count / (float)count;
    float3 sum = (float3)(0.0f);
    for (uint i = 0; i < count; ++i) {
        const uint index = min((uint)(((float)i + u) * step), to->vpl_count - 1);
        const global Vpl* vpl = to->vpls + index;
        const float3 origin = load3(vpl->position);
        const float3 between = at->x - origin;
        const float squared = dot(between, between);
        const float cos_vpl = dot(load3(vpl->normal), between);  // all cosines still carry a factor r
        const float cos_seen = dot(seen_normal(vpl), between);
        const float cos_receiver = -dot(at->n, between);
        if (vpl->depth <= max_depth && cos_vpl > 0.0f && cos_seen > 0.0f && cos_receiver > 0.0f &&
            is_visible(scene, origin, at->x)) {
            const float inverse = rsqrt(squared);
            const float map = receiver_map_factor(at, -between * inverse);
            const float transmission = diffuse_transmission(scene, vpl_curve(vpl), cos_seen * inverse) *
                                       diffuse_transmission(scene, at->curve, cos_receiver * inverse);
            sum += load3(vpl->power) * (cos_vpl * cos_receiver * transmission * map /
                                        (squared * fmax(squared, to->radii[index] * to->radii[index])));
        }
    }
    return count > 0 ? sum * (M_1_PI_F * step) : sum;
}

/// One-path estimate of the irradiance of a receiver over paths of at most `max_edges` edges. It adds up
/// direct light, VPLs under a geometry term that is bounded at their radius, and what one ray of the receiver
/// brings of all other light (lib/receiver_path.cl).
OUTLINED_ON_CPU float3 short_walk_irradiance(const SceneView* scene, const Connections* to,
                                             const ReceiverPoint* at, uint max_edges, uint direct_samples,
                                             uint seed) {
    const uint4 keys = random_uint4((uint4)(0x3a1du, seed, 0u, 0x9a7bu));
    const LightQuota quota = {.samples = direct_samples, .rays = 1, .max_veils = max(max_edges, 1u) - 1};
    float3 irradiance = sampled_direct_light(scene, at, &quota, keys.x);
    if (max_edges > 1) {
        irradiance += connected_irradiance(scene, to, at, max_edges - 1, to_unit_float(keys.w));
    }
    const PathRay ray = receiver_ray(scene, at, 1.0f / (float)direct_samples,
                                     (float2)(to_unit_float(keys.y), to_unit_float(keys.z)));
    const SurfaceHit hit = trace_surface(scene, ray.origin, ray.direction, INFINITY);
    irradiance += ray.throughput * met_light(scene, &ray, &hit);
    if (hit.t < 0.0f || max_edges < 2) {
        return irradiance;
    }
    float weight = 0.0f;
    if (hit.t < to->law.max_radius) {
        const float3 y = off_surface(&hit, hit.geometric);
        weight = remaining_weight(hit.t, gather_radius(scene, &to->law, y, hit.geometric));
    }
    const WantedLight wanted = {.of_vpls = 1.0f - weight,
                                .max_edges = max_edges,
                                .vpl_edges = max_edges,
                                .is_shared = 0,
                                .is_diffuse = 0,
                                .finds_veiled = 0,
                                .shared_limit = INFINITY,
                                .aim = 0};
    Continuation way;
    FoundReflection none = no_reflection_found();
    if (brings_more(scene, &wanted)) {
        const ReceivedLight beyond =
            continued_light(scene, ray, hit, &wanted, random_uint4(keys), &way, &none);
        irradiance += beyond.direct + beyond.indirect;
    }
    return irradiance;
}

#endif
