// SPDX-License-Identifier: Apache-2.0
// The steps of a light walk, for stages that bring their own random numbers.
#ifndef NEARLIGHT_LIB_LIGHT_WALK
#define NEARLIGHT_LIB_LIGHT_WALK

#include "lib/emitter.cl"
#include "lib/material.cl"
#include "lib/vpl.cl"

/// Follows the particle to where it lands: `hit` is what it met, its flux what is reflected there, its origin
/// stands off the surface. False, with both undefined, if it meets nothing or a side that reflects nothing.
inline bool land(const SceneView* scene, EmittedParticle* particle, SurfaceHit* hit) {
    *hit = trace_opaque(scene, particle->origin, particle->direction, INFINITY);
    if (hit->t < 0.0f) {
        return false;
    }
    const global Material* material = scene->materials + hit->material;
    if (!reflects(material, hit->front)) {
        return false;
    }
    particle->flux *= light_albedo(scene, material, hit->uv);
    particle->origin = offset_point(scene, hit->position, hit->geometric);
    return true;
}

/// The VPL that a particle leaves where it landed.
inline Vpl make_deposit(const EmittedParticle* particle, const SurfaceHit* hit, uint depth, uint flags,
                        float3 power) {
    return make_vpl(particle->origin, hit->geometric, depth, flags, power);
}

/// Sends it on from there.
inline void scatter(EmittedParticle* particle, const SurfaceHit* hit, float2 u) {
    particle->direction = to_world_frame(square_to_cosine_hemisphere(u), hit->geometric);
}

#endif
