// SPDX-License-Identifier: Apache-2.0
// The steps of a path that starts at the camera or at a receiver: the light of emitters that a surface
// reflects, by light samples, and the ray that goes on from it and may meet emitters too. Multiple importance
// sampling by the balance heuristic combines the two [Veach & Guibas, Optimally Combining Sampling Techniques
// for Monte Carlo Rendering, 1995].
#ifndef NEARLIGHT_LIB_PATH_RAY
#define NEARLIGHT_LIB_PATH_RAY

#include "lib/bsdf/bsdf.cl"
#include "lib/light/sample.cl"
#include "lib/light/shadow.cl"
#include "lib/outlined.cl"
#include "lib/random.cl"

/// The density, per steradian and for each light sample of a surface, with which the rays of its bundle find
/// the sky in a direction (lib/shared_sky.cl), if they count as `bundle_ratio` rays of its own.
static inline float bundle_density(float3 normal, float3 direction, float bundle_ratio) {
    return bundle_ratio * fmax(dot(normal, direction), 0.0f) * M_1_PI_F;
}

/// The given parts of a surface as what asks lights for light at x. What lets light through asks lights on
/// both of its sides.
static inline LightReceiver light_receiver(float3 x, const SurfaceBsdf* surface, uint parts) {
    if ((parts & BSDF_S) && may_transmit(&surface->bsdf)) {
        return even_receiver(x, (float3)(0.0f));
    }
    const float share = parts == BSDF_S ? 1.0f : parts == BSDF_D ? 0.0f : surface->s_probability;
    return glossy_receiver(x, surface->frame.n, surface->wo, share, lobe_roughness(&surface->bsdf));
}

/// What one light sample sends towards the viewer of a surface through at most `max_veils` veils, if each
/// surface also sends `ray_ratio` rays for each light sample, and `bundle_ratio` of its bundle look for the
/// sky.
static inline float3 reflected_sample(const SceneView* scene, const SurfaceHit* hit,
                                      const SurfaceBsdf* surface, const LightSample* light, uint parts,
                                      float ray_ratio, float bundle_ratio, uint max_veils) {
    if (!may_shine(light)) {
        return (float3)(0.0f);
    }
    float pdf;
    const float3 value = bsdf_eval(scene, surface, light->direction, parts, &pdf);
    if (is_black(value)) {
        return (float3)(0.0f);
    }
    const float3 origin = ray_origin(hit, light->direction);
    const float3 part = arriving_part(scene, origin, light, max_veils);
    if (is_black(part)) {
        return part;
    }
    float density = light->pdf;
    if (!light->is_delta) {
        density += ray_ratio * pdf;
        if (light->infinite && bundle_ratio > 0.0f && bundle_finds_sky(scene, origin, light->direction)) {
            density += bundle_density(surface->frame.n, light->direction, bundle_ratio);
        }
    }
    return value / density * part * light_radiance(scene, light);
}

/// How a surface asks lights: by light samples, and by rays that follow the BSDF.
typedef struct LightQuota {
    uint samples;
    uint rays;         // the first goes on as the path, and the others only look for lights
    uint max_veils;    // that light may pass
    uint bundle_rays;  // rays of the bundle that look for the sky
    uint first;        // number of the first light sample in its sequence
} LightQuota;

/// Whether the given parts of a surface reflect by mirror images and refractions alone, in which light
/// samples find nothing.
static inline bool is_delta_alone(const SurfaceBsdf* surface, uint parts) {
    return is_delta_only(&surface->bsdf) && (!(parts & BSDF_D) || is_black(surface->bsdf.diffuse));
}

/// Radiance that the given parts of a surface send towards the viewer of the light that reaches it straight
/// from lights or through veils, as far as light samples bring it: rays that follow the BSDF bring the rest.
/// `key` is that of the sequence of light samples.
static inline float3 reflected_light(const SceneView* scene, const SurfaceHit* hit,
                                     const SurfaceBsdf* surface, uint parts, const LightQuota* quota,
                                     uint key) {
    float3 exact = (float3)(0.0f);
    if (is_delta_alone(surface, parts)) {
        return exact;
    }
    for (uint i = 0; i < exact_light_count(scene); ++i) {
        const LightSample light = exact_light(scene, i, hit->position);
        exact += reflected_sample(scene, hit, surface, &light, parts, 0.0f, 0.0f, quota->max_veils);
    }
    if (!has_sampled_lights(scene)) {
        return exact;
    }
    const float ray_ratio = (float)quota->rays / (float)quota->samples;
    const float bundle_ratio = (float)quota->bundle_rays / (float)quota->samples;
    const LightReceiver at = light_receiver(hit->position, surface, parts);
    float3 sum = (float3)(0.0f);
    for (uint s = 0; s < quota->samples; ++s) {
        const uint number = quota->first + s;
        const LightSample light =
            sample_light(scene, &at, sample_2d(number, 0, key), sample_2d(number, 1, key));
        sum +=
            reflected_sample(scene, hit, surface, &light, parts, ray_ratio, bundle_ratio, quota->max_veils);
    }
    return exact + sum / (float)quota->samples;
}

/// A ray on its way, and what multiple importance sampling must know of the point that scattered it, which
/// lies before the origin where the ray has passed straight through veils.
typedef struct PathRay {
    float3 origin, direction;
    float3 throughput;
    LightReceiver from;  // where it was scattered
    float pdf;  // density of the direction, per steradian, times rays for each light sample; 0: a delta
    // Rays from one place share the light that lights send straight there (LightQuota.rays): this ray brings
    // this part.
    float part_of_straight;
    float passed;        // distance from where it was scattered to the last veil
    float index;         // refractive index of what it is in ÷ that of where its path began
    float bundle_ratio;  // rays of a bundle that look for the sky as this one does, for each light sample
    uint veils;          // veils that the ray has passed since it was scattered
} PathRay;

/// Starts a path that carries all light back along `direction`. begin_ray() sets the rest.
static inline PathRay first_ray(float3 direction) {
    PathRay ray;
    ray.direction = direction;
    ray.throughput = (float3)(1.0f);
    ray.index = 1.0f;
    return ray;
}

/// Starts the ray where it is scattered.
static inline void begin_ray(PathRay* ray, const LightReceiver* from, float pdf) {
    ray->origin = from->x;
    ray->from = *from;
    ray->pdf = pdf;
    ray->part_of_straight = 1.0f;
    ray->passed = 0.0f;
    ray->veils = 0;
    ray->bundle_ratio = 0.0f;
}

/// Light that a ray met.
typedef struct MetLight {
    float3 radiance;  // that lights send straight along the ray
    float of_others;  // density per steradian with which others look for it, per light sample of where the
                      // ray was scattered
} MetLight;

/// Whether light samples of where the ray was scattered look for the lights that it meets, too.
static inline bool shares_met_light(const PathRay* ray) {
    return ray->pdf > 0.0f && ray->veils <= NEARLIGHT_MAX_VEILS;
}

OUTLINED MetLight find_met_light(const SceneView* scene, const PathRay* ray, const SurfaceHit* hit) {
    MetLight met;
    met.of_others = 0.0f;
    if (hit->t < 0.0f) {
        const MapSample map = map_sample_towards(scene, ray->direction);
        const LightSample sky = sample_of_sky(scene, &ray->from, &map);
        met.radiance = light_radiance(scene, &sky);
        if (shares_met_light(ray)) {
            met.of_others = sky.pdf;
            if (ray->bundle_ratio > 0.0f &&
                (ray->veils == 0 || bundle_finds_sky(scene, ray->from.x, ray->direction))) {
                met.of_others += bundle_density(ray->from.n, ray->direction, ray->bundle_ratio);
            }
        }
        return met;
    }
    met.radiance = emitted_radiance(scene, hit);
    if (!is_black(met.radiance) && shares_met_light(ray)) {
        SurfaceHit seen = *hit;
        seen.t += ray->passed;
        met.of_others = light_pdf(scene, &ray->from, ray->direction, &seen);
    }
    return met;
}

/// The part of the light met that the ray brings; others bring the rest.
static inline float met_weight(const PathRay* ray, const MetLight* met) {
    return shares_met_light(ray) ? ray->part_of_straight * ray->pdf / (ray->pdf + met->of_others) : 1.0f;
}

/// Radiance that lights send straight along the ray, weighted against light samples of where it was
/// scattered.
static inline float3 met_light(const SceneView* scene, const PathRay* ray, const SurfaceHit* hit) {
    const MetLight met = find_met_light(scene, ray, hit);
    return met.radiance * met_weight(ray, &met);
}

/// The largest component of what the ray brings back of power. Refraction scales radiance by the square of
/// the index, which says nothing about how much of the light comes through: what throughput loses where a
/// path enters glass it regains where the path leaves.
static inline float carried_part(const PathRay* ray, float3 albedo) {
    return max_component(ray->throughput * albedo) * ray->index * ray->index;
}

/// At most this part of the paths goes on from a surface where chance ends them. Glass and mirrors send light
/// on almost undiminished: a diamond shows what has met a hundred surfaces, and the fewer paths get there,
/// the more each of them counts.
#define MAX_SURVIVAL 0.99f

/// Turns the ray at a surface into the direction that its BSDF draws. Returns false where the path ends.
OUTLINED bool scatter_ray(const SceneView* scene, PathRay* ray, const SurfaceHit* hit,
                          const SurfaceBsdf* surface, uint parts, float u, float2 v) {
    const BsdfSample sample = bsdf_sample(scene, surface, parts, u, v);
    ray->throughput *= sample.weight;
    ray->index *= surface->unscaled ? 1.0f : sample.eta;
    ray->direction = sample.wi;
    if (sample.is_straight) {
        ray->origin = ray_origin(hit, sample.wi);
        ray->passed += hit->t;
        ++ray->veils;
    } else {
        const LightReceiver from = light_receiver(ray_origin(hit, sample.wi), surface, parts);
        begin_ray(ray, &from, sample.is_delta ? 0.0f : sample.pdf);
    }
    return !is_black(ray->throughput);
}

/// Tells a ray that was scattered how its surface asks lights. It brings the light in a mirror image alone.
static inline void share_lights(PathRay* ray, const LightQuota* quota) {
    if (ray->pdf > 0.0f) {
        ray->pdf *= (float)quota->rays / (float)quota->samples;
        ray->part_of_straight = 1.0f / (float)quota->rays;
        ray->bundle_ratio = (float)quota->bundle_rays / (float)quota->samples;
    }
}

/// Light that the ray meets straight or through at most `max_veils` veils, times its throughput.
static inline float3 light_along(const SceneView* scene, PathRay ray, uint max_veils) {
    float3 sum = (float3)(0.0f);
    float t_min = 0.0f;
    while (!is_black(ray.throughput)) {
        const SurfaceHit hit = trace_between(scene, ray.from.x, ray.direction, t_min, INFINITY);
        sum += ray.throughput * met_light(scene, &ray, &hit);
        if (hit.t < 0.0f || ray.veils >= min(max_veils, (uint)NEARLIGHT_MAX_VEILS) ||
            scene->info->veils == NEARLIGHT_VEILS_NONE) {
            break;
        }
        ray.throughput *= veil_transmittance(scene, &hit, ray.direction);
        ++ray.veils;
        t_min = beyond_surface(&hit, ray.direction);
    }
    return sum;
}

/// What all rays of a quota but the first find, times the throughput of the ray that arrives. `first` is the
/// number of the first of them in the sequence of `key`.
static inline float3 looked_for_light(const SceneView* scene, const PathRay* arriving, const SurfaceHit* hit,
                                      const SurfaceBsdf* surface, uint parts, const LightQuota* quota,
                                      uint first, uint key) {
    float3 sum = (float3)(0.0f);
    for (uint i = 0; i + 1 < quota->rays; ++i) {
        PathRay ray = *arriving;
        if (scatter_ray(scene, &ray, hit, surface, parts, sample_2d(first + i, 0, key).x,
                        sample_2d(first + i, 1, key)) &&
            ray.pdf > 0.0f) {
            share_lights(&ray, quota);
            sum += light_along(scene, ray, quota->max_veils);
        }
    }
    return sum;
}

#endif
