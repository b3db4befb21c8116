// SPDX-License-Identifier: Apache-2.0
// The light of a receiver that VPLs do not bring: direct light, and what rays from the receiver find.
//
// VPLs stand for L_D(y), the light that a surface y reflects by its Lambertian part, under the bounded
// geometry term, whose weight is min(1, r²/R²) at the distance r (R is the clamp radius). A ray from the
// receiver brings the remainder: L_D(y) with the weight max0(1 − r²/R²) [Kollig & Keller, Illumination in the
// Presence of Weak Singularities, 2004], all of L_S(y), which y reflects in any other way, and light that y
// emits. From y on, the path is an ordinary one with next-event estimation at each surface and multiple
// importance sampling by the balance heuristic [Veach & Guibas 1995].
#ifndef NEARLIGHT_LIB_RECEIVER_PATH
#define NEARLIGHT_LIB_RECEIVER_PATH

#include "lib/continued_path.cl"
#include "lib/outlined.cl"
#include "lib/shared_sky.cl"

/// What a receiver leaves to its bundle.
typedef struct Finds {
    FoundLight near;              // Lambertian light of places within the clamp radius
    FoundLight sky;               // light of the sky that its rays meet, straight or through veils
    FoundLight veiled;            // Lambertian light of places behind veils
    FoundReflection reflections;  // light that rough gloss reflects
    const SceneView* solids;      // the scene without veils
    const SceneView* veils;       // the scene of veils alone
} Finds;

/// The finds of a receiver that leaves nothing to its bundle.
static inline Finds nothing_shared(void) {
    const Finds finds = {nothing_found(0), nothing_found(0), nothing_found(0), no_reflection_found(), 0, 0};
    return finds;
}

/// How far rays from receivers go, and what VPLs bring already.
typedef struct PathLimits {
    uint max_edges;      // of a path from the receiver to a light: 1 is direct light
    uint vpl_edges;      // of a path by which VPLs bring light to the receiver
    float clamp_radius;  // R, m; infinite: VPLs bring the receiver nothing
    uint light_samples;  // that each receiver takes of lights
    uint rays;           // rays that each receiver sends
    uint bundle_rays;    // rays of the bundle that count as the receiver's own where they find the sky
    uint sample;         // which of the receivers with the same random numbers it is
    float shared_limit;  // WantedLight.shared_limit
    CausticAim aim;      // where the receiver sends rays besides
} PathLimits;

/// The weight of the Lambertian part of what a ray meets at the distance t; VPLs bring the rest.
static inline float remaining_weight(float t, float clamp_radius) {
    const float ratio = t / clamp_radius;
    return clamp_radius < INFINITY ? fmax(0.0f, 1.0f - ratio * ratio) : 1.0f;
}

/// A ray of a receiver in a direction, weighted as one of cosine-distributed rays.
static inline PathRay receiver_ray_towards(const SceneView* scene, const ReceiverPoint* at,
                                           float rays_per_light_sample, float3 direction) {
    PathRay ray = first_ray(direction);
    const float cosine = fmax(dot(at->n, ray.direction), 0.0f);
    ray.throughput = (float3)(M_PI_F * diffuse_transmission(scene, at->curve, cosine) *
                              receiver_map_factor(at, ray.direction));
    const LightReceiver from = even_receiver(at->x, at->n);
    begin_ray(&ray, &from, rays_per_light_sample * cosine * M_1_PI_F);
    return ray;
}

/// A cosine-distributed ray of a receiver.
static inline PathRay receiver_ray(const SceneView* scene, const ReceiverPoint* at,
                                   float rays_per_light_sample, float2 u) {
    const float3 direction = to_world_frame(square_to_cosine_hemisphere(u), at->n);
    return receiver_ray_towards(scene, at, rays_per_light_sample, direction);
}

// The least weight of a light in draws, as a part of what it sends: other receivers may be in a better place
// for it than the one that found it.
#define OTHER_PLACES 0.05f

/// The light at the place that a ray met, which sends `radiance` to all sides. Its weight in draws is what it
/// brings to the receiver that found it, but not less than OTHER_PLACES says.
static inline SharedLight shared_light(const SurfaceHit* hit, const Continuation* way, float3 radiance,
                                       float of_vpls) {
    SharedLight light;
    light.position = store3(off_surface(hit, hit->geometric));
    light.weight = max_component(radiance) * fmax(1.0f - of_vpls, OTHER_PLACES);
    light.normal = store3(hit->geometric);
    light.curve = (ushort)way->curve;
    light.veils = 0;
    light.radiance = store3(radiance);
    light.shading = pack_direction(way->shading);
    return light;
}

/// The light at the place that a ray met, by what the ray brought back of it.
static inline SharedLight sent_light(const SceneView* scene, const PathRay* ray, const SurfaceHit* hit,
                                     const Continuation* way, float3 brought, float of_vpls) {
    const float sent = diffuse_transmission(scene, way->curve, -dot(way->shading, ray->direction));
    return shared_light(hit, way, brought / (max_component(ray->throughput) * sent), of_vpls);
}

static inline void offer_sky_along(const SceneView* scene, float3 x, float3 direction, uint4 keys,
                                   FoundLight* sky) {
    offer_sky(scene, x, direction, to_unit_float(random_uint4(keys ^ 0x5c1u).x), sky);
}

/// The part of the rays that meet veils which look for light of places behind them. More would find more than
/// bundles use.
#define VEILED_PART 0.25f

/// Finds what lies behind the veils that a ray met first, for the bundle: the sky, or a place. Whether veils
/// let the ray pass is not asked here, because the density of finds must follow from places alone. Returns
/// what stays with the receiver of the light of such a place.
OUTLINED float3 find_behind_veils(const SceneView* scene, const ReceiverPoint* at, const PathLimits* limits,
                                  const PathRay* ray, uint4 keys, Finds* finds) {
    const SurfaceHit behind = trace_surface(finds->solids, at->x, ray->direction, INFINITY);
    if (behind.t < 0.0f) {
        if (finds->sky.is_wanted) {
            offer_sky_along(scene, at->x, ray->direction, keys, &finds->sky);
        }
        return (float3)(0.0f);
    }
    if (!finds->veiled.is_wanted || !(to_unit_float(random_uint4(keys ^ 0x3a11u).x) < VEILED_PART)) {
        return (float3)(0.0f);
    }
    const Veiling veiling = veiling_between(finds->veils, at->x, off_surface(&behind, behind.geometric));
    const uint veils = veiling.count;
    if (veils == 0 || veils > NEARLIGHT_MAX_VEILS || limits->max_edges < veils + 2) {
        return (float3)(0.0f);
    }
    const uint max_edges = limits->max_edges - veils;
    const WantedLight wanted = {.of_vpls = 0.0f,
                                .max_edges = max_edges,
                                .vpl_edges = max_edges,
                                .is_shared = 1,
                                .is_diffuse = 1,
                                .finds_veiled = 0,
                                .shared_limit = VEILED_PART * limits->shared_limit,
                                .aim = 0};
    Continuation way;
    FoundReflection none = no_reflection_found();
    const ReceivedLight light = continued_light(scene, *ray, behind, &wanted, keys ^ 0x7e11u, &way, &none);
    if (!way.is_found) {
        return (float3)(0.0f);
    }
    SharedLight y = sent_light(scene, ray, &behind, &way, light.indirect / VEILED_PART, 0.0f);
    y.veils = (ushort)veils;
    offer_light(&finds->veiled, &y, to_unit_float(random_uint4(keys ^ 0xbe41u).x));
    return veiling.part * way.excess / VEILED_PART;
}

/// The light of lamps that a ray brings if it aims at mirrors and glass and goes on over these alone. The
/// result counts as that of a cosine-distributed ray.
OUTLINED float3 aimed_light(const SceneView* scene, const ReceiverPoint* at, const PathLimits* limits,
                            float2 u, uint4 keys) {
    float3 light = (float3)(0.0f);
    const float3 direction = caustic_direction(&limits->aim, u);
    const float cosine = dot(at->n, direction);
    if (!(cosine > 0.0f)) {
        return light;
    }
    PathRay ray = receiver_ray_towards(scene, at, 1.0f, direction);
    ray.throughput *= unaimed_part(&limits->aim, cosine, direction);
    const float first_weight = max_component(ray.throughput);
    if (!(first_weight > 0.0f)) {
        return light;
    }
    SurfaceHit hit = trace_surface(scene, ray.origin, direction, INFINITY);
    for (uint surfaces = 1; surfaces < limits->max_edges && hit.t >= 0.0f; ++surfaces) {
        const PathNumbers numbers = path_numbers(keys, surfaces);
        const SurfaceBsdf surface = surface_bsdf(scene, &hit, ray.direction, BSDF_RADIANCE, numbers.model);
        float weight = 1.0f;
        const float way = surfaces == 1 ? choose_way_evenly(&surface, numbers.lobe, &weight) : numbers.lobe;
        if (!survives(&ray, bsdf_albedo(scene, &surface), surfaces, first_weight, numbers.end)) {
            break;
        }
        if (is_mirror_or_glass(&surface, false) && !is_delta_only(&surface.bsdf)) {
            const LightQuota quota = {.samples = 1, .rays = 1, .max_veils = limits->max_edges - surfaces - 1};
            light +=
                ray.throughput * reflected_light(scene, &hit, &surface, BSDF_S, &quota, numbers.light_seed);
        }
        if (!scatter_ray(scene, &ray, &hit, &surface, BSDF_S, way, numbers.direction) ||
            !(is_mirror_or_glass(&surface, ray.pdf == 0.0f) || ray.veils == surfaces)) {
            break;
        }
        ray.throughput *= weight;
        hit = trace_surface(scene, ray.origin, ray.direction, INFINITY);
        if (ray.veils != surfaces) {
            light += ray.throughput * met_light(scene, &ray, &hit);
        }
    }
    return light;
}

/// What one cosine-distributed ray of a receiver brings.
static inline ReceivedLight ray_light(const SceneView* scene, const ReceiverPoint* at,
                                      const PathLimits* limits, float2 u, uint4 keys, Finds* finds) {
    ReceivedLight light = nothing_received();
    PathRay ray = receiver_ray(scene, at, (float)limits->rays / (float)limits->light_samples, u);
    ray.bundle_ratio = (float)limits->bundle_rays / (float)limits->light_samples;
    if (is_black(ray.throughput)) {
        return light;
    }
    // Where only near surfaces can bring light, or take away what VPLs bring too much, the ray need not go
    // farther.
    const bool far = scene->info->has_specular || scene->info->has_maps || has_sampled_lights(scene) ||
                     limits->vpl_edges > limits->max_edges;
    const SurfaceHit hit =
        trace_surface(scene, ray.origin, ray.direction, far ? INFINITY : limits->clamp_radius);
    if (limits->max_edges > 0) {
        light.direct = ray.throughput * met_light(scene, &ray, &hit);
    }
    if (hit.t < 0.0f) {
        if (finds->sky.is_wanted && limits->max_edges > 0) {
            offer_sky_along(scene, at->x, ray.direction, keys, &finds->sky);
        }
        return light;
    }
    const bool meets_veil = (scene->materials[hit.material].flags & NEARLIGHT_MATERIAL_VEIL) != 0;
    if (meets_veil && (finds->sky.is_wanted || finds->veiled.is_wanted) && limits->max_edges > 0) {
        light.indirect = find_behind_veils(scene, at, limits, &ray, keys, finds);
    }
    const float of_vpls = 1.0f - remaining_weight(hit.t, limits->clamp_radius);
    const WantedLight wanted = {.of_vpls = of_vpls,
                                .max_edges = limits->max_edges,
                                .vpl_edges = limits->vpl_edges,
                                .is_shared = finds->near.is_wanted && hit.t < limits->clamp_radius,
                                .is_diffuse = 0,
                                .finds_veiled = finds->veiled.is_wanted,
                                .shared_limit = limits->shared_limit,
                                .aim = &limits->aim};
    if (brings_more(scene, &wanted)) {
        Continuation way;
        const ReceivedLight beyond =
            continued_light(scene, ray, hit, &wanted, keys, &way, &finds->reflections);
        light.direct += beyond.direct;
        if (way.is_found) {
            const SharedLight y = sent_light(scene, &ray, &hit, &way, beyond.indirect, of_vpls);
            offer_light(&finds->near, &y, to_unit_float(random_uint4(keys ^ 0xf09du).x));
            light.indirect += (1.0f - of_vpls) * way.excess;
        } else {
            light.indirect += beyond.indirect;
        }
    }
    return light;
}

/// All light of a receiver except what VPLs bring, and except what `finds` keeps for the bundle.
OUTLINED_ON_CPU ReceivedLight received_light(const SceneView* scene, const ReceiverPoint* at,
                                             const PathLimits* limits, uint4 keys, Finds* finds) {
    ReceivedLight light = nothing_received();
    if (limits->vpl_edges == 0 || scene->info->emitter_count == 0) {
        return light;
    }
    const uint first_ray = limits->sample * limits->rays;
    for (uint ray = first_ray; ray < first_ray + limits->rays; ++ray) {
        const ReceivedLight brought = ray_light(scene, at, limits, sample_2d(ray, 2, keys.x),
                                                random_uint4((uint4)(keys.y, keys.z, keys.w, ray)), finds);
        light.direct += brought.direct;
        light.indirect += brought.indirect;
    }
    const CausticAim* aim = &limits->aim;
    const uint first_aimed = limits->sample * aim->aimed_rays;
    for (uint ray = first_aimed; aim->count > 0 && ray < first_aimed + aim->aimed_rays; ++ray) {
        light.indirect += aimed_light(scene, at, limits, sample_2d(ray, 3, keys.x),
                                      random_uint4((uint4)(keys.y, keys.z, ~keys.w, ray)));
    }
    const float scale = 1.0f / (float)max(limits->rays, 1u);
    light.direct *= scale;
    light.indirect *= scale;
    if (limits->max_edges > 0) {
        const LightQuota quota = {.samples = limits->light_samples,
                                  .rays = limits->rays,
                                  .max_veils = limits->max_edges - 1,
                                  .bundle_rays = limits->bundle_rays,
                                  .first = limits->sample * limits->light_samples};
        light.direct += sampled_direct_light(scene, at, &quota, keys.x);
    }
    return light;
}

#endif
