// SPDX-License-Identifier: Apache-2.0
// Sparse quasi-random light tracing (instant radiosity) [Keller, Instant Radiosity, SIGGRAPH 1997; paper §3
// (3)].
//
// light_tracer: one work-item for each walk, from first_walk on. A walk leaves a light, meets up to
// bounce_count surfaces, and deposits a VPL on each that has a Lambertian part. Those that are to be kept go
// one after the other into the walk's slots of `vpls`, from (walk − first_walk) · bounce_count on, and
// `counts` gets how many there are.
// light_tracer_collect: one work-item for each walk copies its deposits to `kept`, from begins[item] on.
// Any work-group size.
//
// Absorption is fractional. A walk is one of `launched` walks, a real number that is all_walks at the light
// and that each surface multiplies by the part of the flux that it sends on, within [min_survival,
// max_survival]. So what walks carry, flux ÷ launched, stays as it was at the light, among bright surfaces
// and dark ones alike, and no VPL of many bounces outshines the others. Walk i ends where i +
// absorption_shift ≥ launched. VPLs are divided by `launched`, never by how many walks arrive. With a uniform
// random shift this is unbiased: of walks along any one path, `launched` are expected to go on.

#include "lib/close_range.cl"
#include "lib/light_walk.cl"
#include "lib/outlined.cl"
#include "lib/random.cl"
#include "shared/light_tracer.h"

/// Whether patches supply the direct light at this point: its triangle was selected and, where the policy
/// decides point by point, the point itself lies in the close range.
static inline bool is_close_surface(const global CloseRange* close_range, const global uint* close_triangles,
                                    uint whole_triangles, uint triangle, float3 position) {
    return close_triangles[triangle] && (whole_triangles || in_close_range(close_range, position));
}

/// The part of the walks that a surface sends on.
static inline float survival(const SceneView* scene, const EmittedParticle* particle, const MetSurface* at,
                             float min_survival, float max_survival) {
    const float3 reflected = particle->flux * bsdf_albedo(scene, &at->surface);
    return clamp(max_component(reflected) / max_component(particle->flux), min_survival, max_survival);
}

/// The close range, and which triangles were selected there; the policy decides by them what is kept of a
/// walk.
typedef struct ClosePlaces {
    const global CloseRange* close_range;
    const global uint* close_triangles;
} ClosePlaces;

/// Follows the walk number `walk` of all, writes what is kept of it to `vpls`, and returns how much that is.
OUTLINED_ON_CPU uint follow_walk(const SceneView* scene, const ClosePlaces* close,
                                 const LightTracerParams* params, const WalkAim* aim, uint walk,
                                 global Vpl* vpls) {
    const uint seed = params->seed;
    uint count = 0;
    EmittedParticle particle = emit_particle(scene, aim, sample_2d(walk, 0, seed).x, sample_2d(walk, 1, seed),
                                             sample_2d(walk, 2, seed));
    float launched = (float)params->all_walks;
    for (uint bounce = 0; bounce < params->bounce_count; ++bounce) {
        const uint pair = NEARLIGHT_WALK_PAIRS_ON_LIGHT + NEARLIGHT_WALK_PAIRS_PER_STEP * bounce;
        const float2 choice = sample_2d(walk, pair, seed);
        MetSurface at;
        if (!((float)walk + params->absorption_shift < launched) || is_black(particle.flux) ||
            !land(scene, &particle, choice.x, &at)) {
            break;
        }
        const float3 reflected = reflected_flux(scene, &particle, &at);
        const bool is_close = is_close_surface(close->close_range, close->close_triangles,
                                               params->whole_triangles, at.hit.triangle, at.hit.position);
        const bool kept = params->keep == NEARLIGHT_KEEP_ALL || !is_close ||
                          (params->keep == NEARLIGHT_KEEP_INDIRECT_INSIDE && bounce > 0);
        if (kept && !is_black(reflected)) {
            vpls[count++] =
                make_deposit(&at, bounce + 1, is_close ? NEARLIGHT_VPL_CLOSE : 0, reflected / launched);
        }
        launched *= survival(scene, &particle, &at, params->min_survival, params->max_survival);
        scatter(scene, &particle, &at, aim, choice.y, sample_2d(walk, pair + 1, seed));
    }
    return count;
}

kernel void light_tracer(SCENE_PARAMETERS, const global CloseRange* restrict close_range,
                         const global uint* restrict close_triangles, LightTracerParams params, WalkAim aim,
                         global Vpl* restrict vpls, global uint* restrict counts) {
    const uint index = (uint)get_global_id(0);
    if (index >= params.walk_count) {
        return;
    }
    const SceneView scene = SCENE_VIEW;
    const ClosePlaces close = {close_range, close_triangles};
    counts[index] = follow_walk(&scene, &close, &params, &aim, params.first_walk + index,
                                vpls + index * params.bounce_count);
}

kernel void light_tracer_collect(const global Vpl* restrict vpls, const global uint* restrict counts,
                                 const global uint* restrict begins, uint walk_count, uint bounce_count,
                                 global Vpl* restrict kept) {
    const uint index = (uint)get_global_id(0);
    if (index >= walk_count) {
        return;
    }
    for (uint i = 0; i < counts[index]; ++i) {
        kept[begins[index] + i] = vpls[index * bounce_count + i];
    }
}
