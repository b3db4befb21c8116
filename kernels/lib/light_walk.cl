// SPDX-License-Identifier: Apache-2.0
// The steps of a walk from a light, for stages that bring their own random numbers.
//
// A walk follows the true BSDFs: it goes through glass and off mirrors. Where a surface has a Lambertian
// part, it may leave a VPL, which stands for what that part reflects of the light that arrives. With shading
// normals a surface receives light by the shading normal's cosine, but particles arrive by the geometric one,
// so the quotient of the two weighs them [Veach, Robust Monte Carlo Methods for Light Transport Simulation,
// 1997, §5.3].
#ifndef NEARLIGHT_LIB_LIGHT_WALK
#define NEARLIGHT_LIB_LIGHT_WALK

#include "lib/aim_cone.cl"
#include "lib/bsdf/bsdf.cl"
#include "lib/light/emission.cl"
#include "lib/outlined.cl"
#include "lib/vpl.cl"
#include "shared/light_walk.h"

/// The surface that a particle met.
typedef struct MetSurface {
    SurfaceHit hit;
    SurfaceBsdf surface;
} MetSurface;

/// Follows the particle to the surface that it meets, of whose BSDFs `u` chooses where there are several.
/// Returns false, with `at` undefined, if there is none.
static inline bool land(const SceneView* scene, const EmittedParticle* particle, float u, MetSurface* at) {
    at->hit = trace_surface(scene, particle->origin, particle->direction, INFINITY);
    if (at->hit.t < 0.0f) {
        return false;
    }
    at->surface = surface_bsdf(scene, &at->hit, particle->direction, BSDF_FLUX, u);
    return true;
}

/// What a map lets a VPL have of the light that it stands for. The VPL has the normal as it is mapped for
/// all viewers, even for those few who see that normal from behind.
static inline float deposit_factor(const SurfaceBsdf* s) {
    if (!s->mapped) {
        return 1.0f;
    }
    const float cosine = dot(s->wo, s->unmapped);
    const bool agrees = cosine * dot(s->wo, s->frame.n) > 0.0f;
    return agrees && s->mapped == MAPPED ? s->scale * map_shadowing(s->tilt2, cosine) : 0.0f;
}

/// What the Lambertian part reflects of the particle's flux, before the transmission on the way out; 0 where
/// there is no such part.
static inline float3 reflected_flux(const SceneView* scene, const EmittedParticle* particle,
                                    const MetSurface* at) {
    const Bsdf* bsdf = &at->surface.bsdf;
    const float geometric = -dot(at->hit.geometric, particle->direction);
    const float shading = -dot(at->surface.frame.n, particle->direction);
    if (is_black(bsdf->diffuse) || !(shading > 0.0f) || !(geometric > 0.0f)) {
        return (float3)(0.0f);
    }
    return particle->flux * bsdf->diffuse *
           (diffuse_transmission(scene, bsdf->curve, shading) * (shading / geometric) *
            deposit_factor(&at->surface));
}

/// The deposit of a particle: the VPL that it leaves where it landed.
static inline Vpl make_deposit(const MetSurface* at, uint depth, uint flags, float3 power) {
    const float3 normal = at->hit.geometric;
    return make_vpl(off_surface(&at->hit, normal), normal, at->surface.frame.n, at->surface.bsdf.curve, depth,
                    flags | mapped_flag(&at->surface), power);
}

/// Whether light that arrives at a surface leaves it in more than a few single directions, so that a walk can
/// aim there.
static inline bool scatters_widely(const Bsdf* bsdf) {
    return !is_black(bsdf->diffuse) || !is_delta_only(bsdf);
}

/// A direction in which a particle goes on from where it landed: one drawn from the BSDF, or one about a
/// sphere at which walks aim. The density is that of all ways together (the balance heuristic).
static inline BsdfSample sample_way_on(const SceneView* scene, const MetSurface* at, const WalkAim* aim,
                                       float u, float2 v) {
    const float3 x = at->hit.position;
    const uint useful = targets_for_surface(aim, x, at->hit.geometric);
    const AimParts parts = divide_aim(aim, scatters_widely(&at->surface.bsdf) ? useful : 0);
    const uint chosen = choose_aim_target(&parts, aim_target_count(aim), &u);
    BsdfSample sample = no_bsdf_sample();
    float3 value;
    if (chosen != NO_AIM_TARGET) {
        const AimTarget target = aim_target(aim, chosen);
        const AimCone cone = aim_cone(&target, x);
        sample.wi = aim_cone_sample(&cone, u < PART_TOWARDS, v);
        value = bsdf_eval(scene, &at->surface, sample.wi, BSDF_D | BSDF_S, &sample.pdf);
    } else {
        sample = bsdf_sample(scene, &at->surface, BSDF_D | BSDF_S, u, v);
        if (sample.is_delta || parts.sum == 0.0f) {
            sample.weight /= 1.0f - parts.sum;
            return sample;
        }
        value = sample.weight * sample.pdf;
    }
    const float pdf = (1.0f - parts.sum) * sample.pdf + aim_pdf(aim, &parts, x, sample.wi);
    sample.weight = pdf > 0.0f ? value / pdf : (float3)(0.0f);
    return sample;
}

/// Sends the particle on from where it landed. Light of a point or a direction that mirrors and glass send on
/// has no flux: no picture of a path tracer holds it, since no path from the camera can find such a light
/// through them, and nearlight converges to the same picture. Where veils are open or glass is clear, shadow
/// rays find such lights straight through veils.
OUTLINED_ON_CPU void scatter(const SceneView* scene, EmittedParticle* particle, const MetSurface* at,
                             const WalkAim* aim, float u, float2 v) {
    const BsdfSample sample = sample_way_on(scene, at, aim, u, v);
    const bool passes = sample.is_straight && scene->info->veils >= NEARLIGHT_VEILS_OPEN;
    const bool is_unseen = sample.is_delta && particle->from_delta && !passes;
    particle->flux = is_unseen ? (float3)(0.0f) : particle->flux * sample.weight;
    particle->direction = sample.wi;
    particle->origin = ray_origin(&at->hit, sample.wi);
    particle->from_delta = particle->from_delta && passes;
}

#endif
