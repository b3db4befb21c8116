// SPDX-License-Identifier: Apache-2.0
// Light sampling for next-event estimation, with the densities that multiple importance sampling needs
// [Veach & Guibas, Optimally Combining Sampling Techniques for Monte Carlo Rendering, 1995].
//
// All light that reaches x from emitters directly is the sum of exact_light(0 … exact_light_count − 1), and
// of what sample_light() estimates with the density light_pdf().
#ifndef NEARLIGHT_LIB_LIGHT_SAMPLE
#define NEARLIGHT_LIB_LIGHT_SAMPLE

#include "lib/light/choice.cl"
#include "lib/light/delta.cl"
#include "lib/light/environment.cl"
#include "lib/light/triangle.cl"

/// Light that arrives at x from one direction, before visibility. For delta lights `radiance` is an
/// irradiance across the direction (intensity/r²), and pdf the probability of choosing the light.
typedef struct LightSample {
    float3 direction;  // unit, from x
    float3 target;     // end of the shadow segment, stands off its surface; undefined if infinite
    float3 radiance;
    float pdf;      // per steradian, with the probability of choosing the light
    uint infinite;  // 1: the light comes from infinitely far away
    uint is_delta;
} LightSample;

inline LightSample sample_delta(const SceneView* scene, const global Emitter* emitter, float3 x) {
    LightSample sample;
    sample.pdf = 1.0f;
    sample.is_delta = 1;
    if (emitter->type == NEARLIGHT_EMITTER_DIRECTIONAL) {
        sample.direction = -load3(emitter->direction);
        sample.target = x;
        sample.radiance = load3(emitter->radiance);
        sample.infinite = 1;
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

inline LightSample sample_area_light(const SceneView* scene, const global Emitter* emitter, float3 x,
                                     float2 u) {
    const TriangleSample on_light = sample_triangle(scene, emitter->triangle, x, u);
    float3 normal;
    const float3 point = triangle_point(scene, emitter->triangle, on_light.barycentrics, &normal);
    LightSample sample;
    sample.target = offset_point(scene, point, normal);
    sample.direction = on_light.direction;
    sample.radiance = on_light.pdf > 0.0f ? triangle_radiance(scene, emitter->triangle, on_light.barycentrics)
                                          : (float3)(0.0f);
    sample.pdf = on_light.pdf;
    sample.infinite = 0;
    sample.is_delta = 0;
    return sample;
}

/// A sample of no use.
inline LightSample no_light(float3 x) {
    LightSample sample;
    sample.direction = (float3)(0.0f, 0.0f, 1.0f);
    sample.target = x;
    sample.radiance = (float3)(0.0f);
    sample.pdf = 0.0f;
    sample.infinite = 1;
    sample.is_delta = 0;
    return sample;
}

/// Whether the light is the environment's map or its sun, which share a direction: a sample of either brings
/// the radiance of both, and has the density of both.
inline bool is_distant(const global Emitter* emitter) {
    return emitter->type == NEARLIGHT_EMITTER_ENVIRONMENT || emitter->type == NEARLIGHT_EMITTER_SUN;
}

/// Light from the entry `index` of the table, with the density that it has once this light is chosen.
inline LightSample sample_emitter(const SceneView* scene, uint index, float3 x, float2 u) {
    const global Emitter* emitter = scene->emitters + index;
    if (emitter->type == NEARLIGHT_EMITTER_TRIANGLE) {
        return sample_area_light(scene, emitter, x, u);
    }
    if (is_distant(emitter)) {
        LightSample sample;
        if (emitter->type == NEARLIGHT_EMITTER_SUN) {
            sample.direction = sample_sun(scene, u);
            sample.radiance = load3(emitter->radiance);
            sample.pdf = 1.0f / (2.0f * M_PI_F * scene->environment->sun_height);
        } else {
            sample.direction = sample_environment(scene, u, &sample.pdf, &sample.radiance);
        }
        sample.target = x;
        sample.infinite = 1;
        sample.is_delta = 0;
        return sample;
    }
    return sample_delta(scene, emitter, x);
}

/// The delta light `index`, below exact_light_count().
inline LightSample exact_light(const SceneView* scene, uint index, float3 x) {
    return sample_delta(scene, scene->emitters + index, x);
}

/// Whether some light is not summed exactly, so that sample_light() has something to choose from.
inline bool has_sampled_lights(const SceneView* scene) {
    return scene->info->emitter_count > exact_light_count(scene);
}

/// Density with which sample_light() picks a direction in which nothing is met.
inline float distant_pdf(const SceneView* scene, float3 x, float3 n, float3 direction) {
    float pdf = 0.0f;
    for (uint index = scene->info->emitter_count; index > 0 && is_distant(scene->emitters + index - 1);
         --index) {
        const bool is_sun = scene->emitters[index - 1].type == NEARLIGHT_EMITTER_SUN;
        pdf += choice_probability(scene, index - 1, x, n) *
               (is_sun ? sun_pdf(scene, direction) : map_pdf(scene, direction));
    }
    return pdf;
}

/// Light at x, whose surface has the normal n (zero: light counts from both sides), from one of the lights
/// that are not summed exactly; there must be one. A sample of no use has a black radiance, and its pdf may
/// be 0.
inline LightSample sample_light(const SceneView* scene, float3 x, float3 n, float2 choice, float2 u) {
    float probability;
    const uint index = choose_light(scene, x, n, choice.x, &probability);
    if (index == ~0u) {
        return no_light(x);
    }
    LightSample sample = sample_emitter(scene, index, x, u);
    sample.pdf *= probability;
    if (is_distant(scene->emitters + index)) {
        sample.radiance = environment_radiance(scene, sample.direction);
        sample.pdf = distant_pdf(scene, x, n, sample.direction);
    }
    return sample;
}

/// The density with which sample_light() at x picks the unit direction in which a ray from x met `hit`, or
/// nothing (t < 0). It is 0 where sample_light() cannot pick it.
inline float light_pdf(const SceneView* scene, float3 x, float3 n, float3 direction, const SurfaceHit* hit) {
    if (scene->info->emitter_count == 0) {
        return 0.0f;
    }
    if (hit->t < 0.0f) {
        return distant_pdf(scene, x, n, direction);
    }
    const float cosine = -dot(hit->geometric, direction);
    if (!hit->front || !(cosine > 0.0f) || is_black(load3(scene->materials[hit->material].emission.value))) {
        return 0.0f;
    }
    const uint index = emitter_of_triangle(scene, hit->triangle);
    return index == ~0u ? 0.0f
                        : choice_probability(scene, index, x, n) *
                              triangle_pdf(scene, hit->triangle, x, hit->t, cosine);
}

inline bool light_is_visible(const SceneView* scene, float3 x, const LightSample* sample) {
    return sample->infinite
               ? !tree_occluded(scene->nodes, scene->tree_triangles, x, sample->direction, 0.0f, INFINITY)
               : is_visible(scene, x, sample->target);
}

/// A sample for receivers that trace no rays of their own. Where the environment is chosen, half the samples
/// follow the cosine, half the tables, and `pdf` is the density of the mixture.
inline LightSample sample_light_or_cosine(const SceneView* scene, float3 x, float3 n, float2 choice,
                                          float2 u) {
    float probability;
    const uint index = choose_light(scene, x, n, choice.x, &probability);
    if (index == ~0u) {
        return no_light(x);
    }
    LightSample light;
    if (scene->emitters[index].type != NEARLIGHT_EMITTER_ENVIRONMENT) {
        light = sample_emitter(scene, index, x, u);
    } else {
        if (choice.y < 0.5f) {
            light.direction = to_world_frame(square_to_cosine_hemisphere(u), n);
            const uint2 pixel = environment_pixel(scene, light.direction);
            light.radiance = map_radiance(scene, light.direction);
            light.pdf = environment_pixel_pdf(scene, pixel);
        } else {
            light.direction = sample_environment(scene, u, &light.pdf, &light.radiance);
        }
        light.pdf = 0.5f * (light.pdf + fmax(0.0f, dot(n, light.direction)) * M_1_PI_F);
        light.target = x;
        light.infinite = 1;
        light.is_delta = 0;
    }
    light.pdf *= probability;
    return light;
}

#endif
