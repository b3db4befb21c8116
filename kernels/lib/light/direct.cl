// SPDX-License-Identifier: Apache-2.0
// Irradiance from all lights, with shadow rays.
#ifndef NEARLIGHT_LIB_LIGHT_DIRECT
#define NEARLIGHT_LIB_LIGHT_DIRECT

#include "lib/light/sample.cl"
#include "lib/random.cl"

/// Irradiance at x (normal n) from the lights that are few enough to be summed all.
inline float3 exact_irradiance(const SceneView* scene, float3 x, float3 n) {
    float3 irradiance = (float3)(0.0f);
    const uint count = exact_light_count(scene);
    for (uint i = 0; i < count; ++i) {
        const LightSample light = exact_light(scene, i, x);
        const float cosine = dot(n, light.direction);
        if (cosine > 0.0f && !is_black(light.radiance) && light_is_visible(scene, x, &light)) {
            irradiance += light.radiance * cosine;
        }
    }
    return irradiance;
}

/// What a light sample brings to the irradiance at x if `cosine_samples` cosine-distributed rays of x for
/// each light sample find lights too: the balance heuristic divides by the sum of the densities.
inline float3 combined_irradiance(const SceneView* scene, float3 x, float3 n, const LightSample* light,
                                  float cosine_samples) {
    const float cosine = dot(n, light->direction);
    if (!(cosine > 0.0f) || is_black(light->radiance) || !light_is_visible(scene, x, light)) {
        return (float3)(0.0f);
    }
    const float cosine_pdf = light->is_delta ? 0.0f : cosine_samples * cosine * M_1_PI_F;
    return light->radiance * (cosine / (light->pdf + cosine_pdf));
}

/// Irradiance (W/m²) at x (unit normal n, off its surface) from all lights, for multiple importance sampling:
/// a cosine-distributed ray of x that finds the radiance L of a light adds π·L·w/bsdf_sample_count, where w =
/// c/(c + sample_count·light_pdf()) and c = bsdf_sample_count·cosθ/π. This function adds the rest. Delta
/// lights up to MAX_EXACT_LIGHTS are exact, the other lights are estimated from `sample_count` samples, for
/// which `seed` tells one receiver from another.
inline float3 direct_irradiance_mis(const SceneView* scene, float3 x, float3 n, uint sample_count,
                                    uint bsdf_sample_count, uint seed) {
    const float3 exact = exact_irradiance(scene, x, n);
    if (!has_sampled_lights(scene)) {
        return exact;
    }
    const float cosine_samples = (float)bsdf_sample_count / (float)sample_count;
    float3 sum = (float3)(0.0f);
    for (uint s = 0; s < sample_count; ++s) {
        const LightSample light = sample_light(scene, x, n, sample_2d(s, 0, seed), sample_2d(s, 1, seed));
        sum += combined_irradiance(scene, x, n, &light, cosine_samples);
    }
    return exact + sum / (float)sample_count;
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
            light.radiance = scene->environment_pixels[pixel.y * scene->environment->width + pixel.x].xyz;
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
/// trace no rays of their own; otherwise as direct_irradiance_mis().
inline float3 direct_irradiance(const SceneView* scene, float3 x, float3 n, uint sample_count, uint seed) {
    const float3 exact = exact_irradiance(scene, x, n);
    if (!has_sampled_lights(scene)) {
        return exact;
    }
    float3 sum = (float3)(0.0f);
    for (uint s = 0; s < sample_count; ++s) {
        const LightSample light =
            sample_light_or_cosine(scene, x, n, sample_2d(s, 0, seed), sample_2d(s, 1, seed));
        sum += combined_irradiance(scene, x, n, &light, 0.0f);
    }
    return exact + sum / (float)sample_count;
}

#endif
