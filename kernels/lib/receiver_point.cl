// SPDX-License-Identifier: Apache-2.0
// A place that receives light by its Lambertian part, and the direct light that light samples bring to it.
#ifndef NEARLIGHT_LIB_RECEIVER_POINT
#define NEARLIGHT_LIB_RECEIVER_POINT

#include "lib/path_ray.cl"

/// A place that receives light by its Lambertian part.
typedef struct ReceiverPoint {
    float3 x;       // off its surface
    float3 n;       // shading normal
    float3 mesh_n;  // the mesh's own, where a map has tilted n; zero without a map
    uint curve;     // row of the transmission curve that weighs arriving light
} ReceiverPoint;

/// The Lambertian part of a surface as a receiver at x, which stands off it.
static inline ReceiverPoint receiver_of(float3 x, const SurfaceBsdf* surface) {
    ReceiverPoint at;
    at.x = x;
    at.n = surface->frame.n;
    at.mesh_n = surface->mapped ? surface->unmapped : (float3)(0.0f);
    at.curve = surface->bsdf.curve;
    return at;
}

/// The part of light along `direction` (towards the light, and above the receiver's own horizon) that its map
/// lets through.
static inline float receiver_map_factor(const ReceiverPoint* at, float3 direction) {
    return unshadowed_part(at->n, at->mesh_n, direction);
}

/// Irradiance (W/m²) from two kinds of paths.
typedef struct ReceivedLight {
    float3 direct;    // from a light straight to the receiver
    float3 indirect;  // over at least one more surface
} ReceivedLight;

static inline ReceivedLight nothing_received(void) {
    ReceivedLight none;
    none.direct = none.indirect = (float3)(0.0f);
    return none;
}

/// What a light sample brings to the irradiance of a receiver through at most `max_veils` veils, weighted for
/// `ray_ratio` cosine-distributed rays for each light sample, and for `bundle_ratio` more of its bundle that
/// look for the sky.
static inline float3 sampled_irradiance(const SceneView* scene, const ReceiverPoint* at,
                                        const LightSample* light, float ray_ratio, float bundle_ratio,
                                        uint max_veils) {
    const float cosine = dot(at->n, light->direction);
    if (!(cosine > 0.0f) || !may_shine(light)) {
        return (float3)(0.0f);
    }
    const float response =
        cosine * diffuse_transmission(scene, at->curve, cosine) * receiver_map_factor(at, light->direction);
    if (!(response > 0.0f)) {
        return (float3)(0.0f);
    }
    const float3 part = arriving_part(scene, at->x, light, max_veils);
    if (is_black(part)) {
        return part;
    }
    float density = light->pdf;
    if (!light->is_delta) {
        const bool of_bundle =
            light->infinite && bundle_ratio > 0.0f && bundle_finds_sky(scene, at->x, light->direction);
        const float rays = ray_ratio + (of_bundle ? bundle_ratio : 0.0f);
        density += rays * cosine * M_1_PI_F;
    }
    return density > 0.0f ? response / density * part * light_radiance(scene, light) : (float3)(0.0f);
}

/// The part of the direct light that light samples bring, beside the receiver's rays; without rays, light
/// samples bring all of it. Delta lights are summed exactly if there are at most NEARLIGHT_MAX_EXACT_LIGHTS.
/// `key` is that of the sequence of light samples.
static inline float3 sampled_direct_light(const SceneView* scene, const ReceiverPoint* at,
                                          const LightQuota* quota, uint key) {
    float3 exact = (float3)(0.0f);
    for (uint i = 0; i < exact_light_count(scene); ++i) {
        const LightSample light = exact_light(scene, i, at->x);
        exact += sampled_irradiance(scene, at, &light, 0.0f, 0.0f, quota->max_veils);
    }
    if (!has_sampled_lights(scene)) {
        return exact;
    }
    const float ray_ratio = (float)quota->rays / (float)quota->samples;
    const float bundle_ratio = (float)quota->bundle_rays / (float)quota->samples;
    const LightReceiver receiver = even_receiver(at->x, at->n);
    float3 sum = (float3)(0.0f);
    for (uint s = 0; s < quota->samples; ++s) {
        const float2 choice = sample_2d(quota->first + s, 0, key);
        const float2 u = sample_2d(quota->first + s, 1, key);
        const LightSample light = quota->rays > 0 ? sample_light(scene, &receiver, choice, u)
                                                  : sample_light_or_cosine(scene, &receiver, choice, u);
        sum += sampled_irradiance(scene, at, &light, ray_ratio, bundle_ratio, quota->max_veils);
    }
    return exact + sum / (float)quota->samples;
}

#endif
