// SPDX-License-Identifier: Apache-2.0
// Irradiance from all lights, with shadow rays.
#ifndef NEARLIGHT_LIB_LIGHT_DIRECT
#define NEARLIGHT_LIB_LIGHT_DIRECT

#include "lib/light/sample.cl"
#include "lib/random.cl"

/// What a light sample brings to the irradiance at x (normal n).
inline float3 arriving_irradiance(const SceneView* scene, float3 x, float3 n, const LightSample* light) {
    const float cosine = dot(n, light->direction);
    if (!(cosine > 0.0f) || is_black(light->radiance) || !light_is_visible(scene, x, light)) {
        return (float3)(0.0f);
    }
    return light->radiance * (cosine / light->pdf);
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

/// The whole irradiance (W/m²) at x (unit normal n, off its surface) from all lights, for receivers that
/// trace no rays of their own. Delta lights up to MAX_EXACT_LIGHTS are exact, the other lights are estimated
/// from `sample_count` samples, for which `seed` tells one receiver from another.
inline float3 direct_irradiance(const SceneView* scene, float3 x, float3 n, uint sample_count, uint seed) {
    float3 exact = (float3)(0.0f);
    for (uint i = 0; i < exact_light_count(scene); ++i) {
        const LightSample light = exact_light(scene, i, x);
        exact += arriving_irradiance(scene, x, n, &light);
    }
    if (!has_sampled_lights(scene)) {
        return exact;
    }
    float3 sum = (float3)(0.0f);
    for (uint s = 0; s < sample_count; ++s) {
        const LightSample light =
            sample_light_or_cosine(scene, x, n, sample_2d(s, 0, seed), sample_2d(s, 1, seed));
        sum += arriving_irradiance(scene, x, n, &light);
    }
    return exact + sum / (float)sample_count;
}

#endif
