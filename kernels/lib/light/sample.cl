// SPDX-License-Identifier: Apache-2.0
// Light sampling for next-event estimation, with the densities that multiple importance sampling needs
// [Veach & Guibas, Optimally Combining Sampling Techniques for Monte Carlo Rendering, 1995].
//
// All light that reaches x from emitters directly is the sum of exact_light(0 … exact_light_count − 1), and
// of what sample_light() estimates with the density light_pdf().
#ifndef NEARLIGHT_LIB_LIGHT_SAMPLE
#define NEARLIGHT_LIB_LIGHT_SAMPLE

#include "lib/light/choice.cl"
#include "lib/light/cylinder.cl"
#include "lib/light/delta.cl"
#include "lib/light/environment.cl"
#include "lib/light/triangle.cl"
#include "lib/outlined.cl"

/// Light that arrives at x from one direction, before visibility. For delta lights `radiance` is an
/// irradiance across the direction (intensity/r²), and pdf the probability of choosing the light. Radiance of
/// the environment's map is looked up when it is known to arrive (light_radiance), because a map is large and
/// far from the processor.
typedef struct LightSample {
    float3 direction;  // unit, from x
    float3 target;     // end of the shadow segment, stands off its surface; undefined if infinite
    float3 radiance;   // without that of the map
    float pdf;         // per steradian, with the probability of choosing the light
    uint infinite;     // 1: the light comes from infinitely far away
    uint is_delta;
    uint on_map;   // 1: the direction looks at the map
    float2 place;  // where on the map
} LightSample;

static inline LightSample no_light(float3 x) {
    LightSample sample;
    sample.direction = (float3)(0.0f, 0.0f, 1.0f);
    sample.target = x;
    sample.radiance = (float3)(0.0f);
    sample.pdf = 0.0f;
    sample.infinite = 1;
    sample.is_delta = 0;
    sample.on_map = 0;
    sample.place = (float2)(0.0f);
    return sample;
}

/// Whether the sample may bring light.
static inline bool may_shine(const LightSample* light) {
    return light->on_map || !is_black(light->radiance);
}

static inline float3 light_radiance(const SceneView* scene, const LightSample* light) {
    return light->on_map ? light->radiance + map_radiance(scene, light->place) : light->radiance;
}

OUTLINED LightSample sample_delta(const SceneView* scene, const global Emitter* emitter, float3 x) {
    LightSample sample = no_light(x);
    sample.pdf = 1.0f;
    sample.is_delta = 1;
    if (emitter->type == NEARLIGHT_EMITTER_DIRECTIONAL) {
        sample.direction = -load3(emitter->direction);
        sample.radiance = load3(emitter->radiance);
        return sample;
    }
    sample.target = load3(emitter->position);
    const float3 to_light = sample.target - x;
    const float squared = dot(to_light, to_light);
    sample.direction = squared > 0.0f ? to_light * rsqrt(squared) : (float3)(0.0f, 0.0f, 1.0f);
    sample.radiance =
        squared > 0.0f ? delta_intensity(scene, emitter, -sample.direction) / squared : (float3)(0.0f);
    sample.infinite = 0;
    return sample;
}

static inline LightSample sample_triangle_light(const SceneView* scene, const global Emitter* emitter,
                                                float3 x, float2 u) {
    const TriangleSample on_light = sample_triangle(scene, emitter->triangle, x, u);
    float3 normal;
    const float3 point = triangle_point(scene, emitter->triangle, on_light.barycentrics, &normal);
    LightSample sample = no_light(x);
    sample.target = point + triangle_stand_off(scene, emitter->triangle) * normal;
    sample.direction = on_light.direction;
    sample.radiance = on_light.pdf > 0.0f ? triangle_radiance(scene, emitter->triangle, on_light.barycentrics)
                                          : (float3)(0.0f);
    sample.pdf = on_light.pdf;
    sample.infinite = 0;
    return sample;
}

static inline LightSample sample_round_light(const SceneView* scene, const global Emitter* emitter, float3 x,
                                             float2 u) {
    const RoundSample on_light = emitter->type == NEARLIGHT_EMITTER_SPHERE ? sample_sphere(emitter, x, u)
                                                                           : sample_cylinder(emitter, x, u);
    LightSample sample = no_light(x);
    sample.target = off_round_light(scene, emitter, on_light.point, on_light.normal);
    sample.direction = on_light.direction;
    sample.radiance = on_light.pdf > 0.0f ? load3(emitter->radiance) : (float3)(0.0f);
    sample.pdf = on_light.pdf;
    sample.infinite = 0;
    return sample;
}

/// Light from the entry `index` of the table, which is neither the map nor the sun, with the density that it
/// has once this light is chosen.
OUTLINED LightSample sample_emitter(const SceneView* scene, uint index, float3 x, float2 u) {
    const global Emitter* emitter = scene->emitters + index;
    if (emitter->type == NEARLIGHT_EMITTER_TRIANGLE) {
        return sample_triangle_light(scene, emitter, x, u);
    }
    if (is_area_light(emitter)) {
        return sample_round_light(scene, emitter, x, u);
    }
    return sample_delta(scene, emitter, x);
}

/// The delta light `index`, below exact_light_count().
static inline LightSample exact_light(const SceneView* scene, uint index, float3 x) {
    return sample_delta(scene, scene->emitters + index, x);
}

/// Whether some light is not summed exactly, so that sample_light() has something to choose from.
static inline bool has_sampled_lights(const SceneView* scene) {
    return scene->info->emitter_count > exact_light_count(scene);
}

/// Density with which sample_light() picks a direction in which nothing is met. `map_density` is
/// MapSample.pdf there.
static inline float distant_pdf(const SceneView* scene, const LightReceiver* at, float3 direction,
                                float map_density) {
    float pdf = 0.0f;
    for (uint index = scene->info->emitter_count; index > 0 && is_distant(scene->emitters + index - 1);
         --index) {
        const bool is_sun = scene->emitters[index - 1].type == NEARLIGHT_EMITTER_SUN;
        pdf += choice_probability(scene, index - 1, at) * (is_sun ? sun_pdf(scene, direction) : map_density);
    }
    return pdf;
}

/// A sample of a lamp that was chosen with this probability.
static inline LightSample sample_of_lamp(const SceneView* scene, const LightReceiver* at, uint index,
                                         float probability, float2 u) {
    LightSample sample = sample_emitter(scene, index, at->x, u);
    sample.pdf *= probability;
    return sample;
}

/// A sample of the sky: of the map, and of the sun where the direction meets it.
static inline LightSample sample_of_sky(const SceneView* scene, const LightReceiver* at,
                                        const MapSample* map) {
    LightSample sample = no_light(at->x);
    sample.direction = map->direction;
    sample.radiance = sun_radiance(scene, map->direction);
    sample.pdf = distant_pdf(scene, at, map->direction, map->pdf);
    sample.on_map = has_map(scene);
    sample.place = map->place;
    return sample;
}

/// Light at the receiver from one of the lights that are not summed exactly; there must be one. A sample of
/// no use has a black radiance, and its pdf may be 0.
OUTLINED LightSample sample_light(const SceneView* scene, const LightReceiver* at, float2 choice, float2 u) {
    float probability;
    const uint index = choose_light(scene, at, choice.x, &probability);
    if (index == ~0u) {
        return no_light(at->x);
    }
    const global Emitter* emitter = scene->emitters + index;
    if (!is_distant(emitter)) {
        return sample_of_lamp(scene, at, index, probability, u);
    }
    const MapSample map =
        emitter->type == NEARLIGHT_EMITTER_SUN ? map_sample_towards_sun(scene, u) : sample_map(scene, u);
    return sample_of_sky(scene, at, &map);
}

/// The density with which sample_light() picks the unit direction in which a ray from the receiver met `hit`,
/// or nothing (t < 0). It is 0 where sample_light() cannot pick it.
static inline float light_pdf(const SceneView* scene, const LightReceiver* at, float3 direction,
                              const SurfaceHit* hit) {
    if (scene->info->emitter_count == 0) {
        return 0.0f;
    }
    if (hit->t < 0.0f) {
        return distant_pdf(scene, at, direction, map_sample_towards(scene, direction).pdf);
    }
    const float cosine = -dot(hit->geometric, direction);
    if (!hit->front || !(cosine > 0.0f) || is_black(load3(scene->materials[hit->material].emission.value))) {
        return 0.0f;
    }
    const uint index = emitter_of_triangle(scene, hit->triangle);
    if (index == ~0u) {
        return 0.0f;
    }
    const global Emitter* emitter = scene->emitters + index;
    float pdf;
    if (emitter->type == NEARLIGHT_EMITTER_SPHERE) {
        pdf = sphere_pdf(emitter, at->x, direction);
    } else if (emitter->type == NEARLIGHT_EMITTER_CYLINDER) {
        pdf = cylinder_pdf(emitter, at->x, direction);
    } else {
        pdf = triangle_pdf(scene, hit->triangle, at->x, hit->t, cosine);
    }
    return choice_probability(scene, index, at) * pdf;
}

static inline bool light_is_visible(const SceneView* scene, float3 x, const LightSample* sample) {
    return sample->infinite
               ? !tree_occluded(scene->nodes, scene->tree_triangles, x, sample->direction, 0.0f, INFINITY)
               : is_visible(scene, x, sample->target);
}

/// A sample for receivers that trace no rays of their own. Where the environment is chosen, half the samples
/// follow the cosine, half the tables, and `pdf` is the density of the mixture.
static inline LightSample sample_light_or_cosine(const SceneView* scene, const LightReceiver* at,
                                                 float2 choice, float2 u) {
    float probability;
    const uint index = choose_light(scene, at, choice.x, &probability);
    if (index == ~0u) {
        return no_light(at->x);
    }
    const global Emitter* emitter = scene->emitters + index;
    if (!is_distant(emitter)) {
        return sample_of_lamp(scene, at, index, probability, u);
    }
    MapSample map;
    if (emitter->type == NEARLIGHT_EMITTER_SUN) {
        map = map_sample_towards_sun(scene, u);
    } else if (choice.y < 0.5f) {
        map = map_sample_towards(scene, to_world_frame(square_to_cosine_hemisphere(u), at->n));
    } else {
        map = sample_map(scene, u);
    }
    map.pdf = 0.5f * (map.pdf + fmax(0.0f, dot(at->n, map.direction)) * M_1_PI_F);
    return sample_of_sky(scene, at, &map);
}

#endif
