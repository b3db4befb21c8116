// SPDX-License-Identifier: Apache-2.0
// Walks from lights over mirrors and glass to the first Lambertian surface, which tell receivers near there
// where to look for the light (lib/caustic_aim.cl).
//
// caustic_walks: one work-item for each walk, from first_walk on; any work-group size. A walk follows mirror
// images, refractions and rough glass alone, and of the two ways on from smooth glass it takes the rarer one
// more often than light does. What passes straight on is no mirror and no glass. Points and directions emit
// no such walks, since no ray finds such a light.

#include "lib/caustic_aim.cl"
#include "lib/light_walk.cl"
#include "lib/outlined.cl"
#include "lib/random.cl"

#define MAX_CAUSTIC_BOUNCES 16  // surfaces after which a walk is given up

OUTLINED_ON_CPU CausticLanding follow_caustic(const SceneView* scene, uint walk, uint seed) {
    CausticLanding landing;
    landing.place = landing.target = store3((float3)(0.0f));
    landing.is_there = 0;
    WalkAim nowhere;
    nowhere.radius = 0.0f;
    nowhere.opening_count = 0;
    EmittedParticle particle = emit_particle(scene, &nowhere, sample_2d(walk, 0, seed).x,
                                             sample_2d(walk, 1, seed), sample_2d(walk, 2, seed));
    bool is_caustic = false;
    for (uint bounce = 0; bounce < MAX_CAUSTIC_BOUNCES && !particle.from_delta && !is_black(particle.flux);
         ++bounce) {
        const uint4 random = random_uint4((uint4)(walk, bounce, 0xca57u, seed));
        MetSurface at;
        if (!land(scene, &particle, to_unit_float(random.x), &at)) {
            break;
        }
        if (is_caustic && !is_black(reflected_flux(scene, &particle, &at))) {
            landing.place = store3(at.hit.position);
            landing.is_there = 1;
            break;
        }
        float weight;
        const float way = choose_way_evenly(&at.surface, to_unit_float(random.y), &weight);
        const BsdfSample sample = bsdf_sample(scene, &at.surface, BSDF_D | BSDF_S, way,
                                              (float2)(to_unit_float(random.z), to_unit_float(random.w)));
        if (!is_mirror_or_glass(&at.surface, sample.is_delta)) {
            break;
        }
        if (!sample.is_straight) {
            is_caustic = true;
            landing.target = store3(at.hit.position);
        }
        particle.flux *= sample.weight;
        particle.direction = sample.wi;
        particle.origin = ray_origin(&at.hit, sample.wi);
    }
    return landing;
}

kernel void caustic_walks(SCENE_PARAMETERS, uint first_walk, uint walk_count, uint seed,
                          global CausticLanding* restrict landings) {
    const uint index = (uint)get_global_id(0);
    if (index >= walk_count) {
        return;
    }
    const SceneView scene = SCENE_VIEW;
    landings[index] = follow_caustic(&scene, first_walk + index, seed);
}
