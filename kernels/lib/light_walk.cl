// SPDX-License-Identifier: Apache-2.0
// The steps of a walk, for stages that bring their own random numbers.
#ifndef NEARLIGHT_LIB_LIGHT_WALK
#define NEARLIGHT_LIB_LIGHT_WALK

#include "lib/light/emission.cl"
#include "lib/material.cl"
#include "lib/vpl.cl"

/// Follows the particle to where it lands. `hit` gets what it met, its flux becomes what is reflected there,
/// and its origin stands off the surface. Returns false, with both undefined, if the particle meets nothing
/// or a side that reflects nothing.
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

/// The deposit of a particle: the VPL that it leaves where it landed.
inline Vpl make_deposit(const EmittedParticle* particle, const SurfaceHit* hit, uint depth, uint flags,
                        float3 power) {
    return make_vpl(particle->origin, hit->geometric, depth, flags, power);
}

/// Sends the particle on from where it landed, in a cosine-distributed direction.
inline void scatter(EmittedParticle* particle, const SurfaceHit* hit, float2 u) {
    particle->direction = to_world_frame(square_to_cosine_hemisphere(u), hit->geometric);
}

#endif
