// SPDX-License-Identifier: Apache-2.0
// Light of the sky that rays of single receivers find and that all receivers of their bundle share.
//
// The direct light of the sky at a receiver x is ∫ L(x→y)·G(x, y)·V(x, y) dy over the places y of a sphere
// around the scene (lib/shared_sky.cl), where L is the radiance of the sky in the direction of y. Bundles
// choose lights y_j among those that the rays of their receivers found, and test who sees them, as in
// shared_lights.cl:
//
//     E(x) ≈ Σ_j w(x, y_j)·L(x→y_j)·T(x, y_j)·G(x, y_j)·V(x, y_j) / p(y_j)
//     p(y) = Σ_s m/π · G(s, y)·V(s, y)
//
// Here V is the visibility past solid surfaces alone, and T the transmittance of the veils between
// (lib/light/shadow.cl): rays find places behind veils whatever these let through.
//
// What the surface of x reflects other than diffusely towards the camera is the same sum with its BSDF S. The
// weight w is that of the balance heuristic between the rays of the bundle, those of x and its light samples,
// for which NEARLIGHT_SKY_RAYS rays of the bundle count for each of a receiver's own [Veach & Guibas 1995].
//
// shared_sky_gather: one work-item for each receiver adds to its irradiance, and with `has_seen` to the light
// that its camera path met (`vertices`). The lists are those of shared_lights.cl. Any work-group size.

#include "lib/bsdf/bsdf.cl"
#include "lib/light/shadow.cl"
#include "lib/outlined.cl"
#include "lib/shared_sky.cl"

/// Light of the sky that arrives at a receiver from the place of a shared light.
typedef struct ArrivingSky {
    float3 direction;
    float3 radiance;
    float pdf;     // of a light sample in this direction, per steradian
    float solid;   // of a patch at the light, as x sees it: cosθy/r² (1/m²)
    float cosine;  // at x
} ArrivingSky;

static inline ArrivingSky arriving_sky(const SceneView* scene, const global SharedLight* light, float3 x,
                                       float3 n) {
    const float3 to_light = load3(light->position) - x;
    const float squared = dot(to_light, to_light);
    const float inverse = rsqrt(squared);
    ArrivingSky sky;
    sky.direction = to_light * inverse;
    sky.solid = -dot(load3(light->normal), sky.direction) / squared;
    sky.cosine = dot(n, sky.direction);
    const MapSample map = map_sample_towards(scene, sky.direction);
    const LightReceiver at = even_receiver(x, n);
    const LightSample sample = sample_of_sky(scene, &at, &map);
    sky.radiance = light_radiance(scene, &sample);
    sky.pdf = sample.pdf;
    return sky;
}

/// The part of the sky's light that rays of the bundle bring to a surface, where other samples of a total
/// density `of_others` look for it too.
static inline float bundle_weight(const ArrivingSky* sky, float bundle_rays, float of_others) {
    const float of_bundle = bundle_rays * sky->cosine * M_1_PI_F;
    return of_bundle / (of_bundle + of_others);
}

/// The surface that the camera saw at a receiver.
static inline SurfaceBsdf resolve_seen(const SceneView* scene, const global SeenSurface* seen) {
    const float3 direction = load3(seen->direction);
    const SurfaceHit hit = surface_met_at(scene, seen->triangle, (float2)(seen->u, seen->v), direction);
    return surface_bsdf(scene, &hit, direction, BSDF_CAMERA, seen->model);
}

/// A receiver, and the surface that the camera sees there if that reflects other than diffusely.
typedef struct SkyReceiver {
    float3 x, n;
    uint curve;
    float rays, light_samples;  // of its own
    float bundle_rays;
    uint max_veils;  // that light may pass
    const global SeenSurface* seen;
    float seen_rays, seen_samples;  // of the surface seen; no samples: there is none
} SkyReceiver;

/// What a bundle's lights bring to a receiver.
typedef struct SkyLight {
    float3 irradiance;
    float3 reflected;  // radiance that the surface seen reflects towards the camera by S
} SkyLight;

/// Sums the listed lights that the receiver sees, which is at `place` in its bundle.
OUTLINED_ON_CPU SkyLight sum_sky(const SceneView* scene, const SceneView* veils, const SkyReceiver* at,
                                 const global SharedLight* found, const global uint* listed,
                                 const global float* factors, uint length, const global uint* seen_by,
                                 uint place) {
    SkyLight sum;
    sum.irradiance = sum.reflected = (float3)(0.0f);
    SurfaceBsdf surface;
    bool is_resolved = false;
    for (uint entry = 0; entry < length; ++entry) {
        if (!is_seen_by(seen_by + entry * BUNDLE_WORDS, place)) {
            continue;
        }
        const global SharedLight* light = found + listed[entry];
        const ArrivingSky sky = arriving_sky(scene, light, at->x, at->n);
        float3 radiance = sky.radiance * (light->radiance.x * factors[entry] * sky.solid);
        if (scene->info->veils != NEARLIGHT_VEILS_NONE) {
            radiance *= transmittance_to_sky(veils, at->x, sky.direction, at->max_veils);
        }
        const float of_others = at->rays * sky.cosine * M_1_PI_F + at->light_samples * sky.pdf;
        sum.irradiance += radiance * (bundle_weight(&sky, at->bundle_rays, of_others) * sky.cosine *
                                      curve_value(scene->curves, at->curve, sky.cosine));
        if (at->seen_samples > 0.0f) {
            if (!is_resolved) {
                surface = resolve_seen(scene, at->seen);
                is_resolved = true;
            }
            float pdf;
            const float3 value = bsdf_eval(scene, &surface, sky.direction, BSDF_S, &pdf);
            sum.reflected +=
                value * radiance *
                bundle_weight(&sky, at->bundle_rays, at->seen_rays * pdf + at->seen_samples * sky.pdf);
        }
    }
    return sum;
}

kernel void shared_sky_gather(SCENE_PARAMETERS, VEIL_PARAMETERS,
                              const global ReceiverPacket* restrict receivers, SharedSkyParams params,
                              const global SharedLight* restrict found, const global uint* restrict listed,
                              const global float* restrict factors, const global uint* restrict lengths,
                              const global uint* restrict seen_by,
                              global IrradiancePacket* restrict irradiance,
                              const global SeenSurface* restrict seen,
                              global CameraVertex* restrict vertices) {
    const uint receiver = (uint)get_global_id(0);
    const uint packet = receiver / NEARLIGHT_PACKET_SIZE;
    const uint lane = receiver % NEARLIGHT_PACKET_SIZE;
    if (packet >= params.packet_count) {
        return;
    }
    const SceneView scene = SCENE_VIEW;
    const SceneView veils = VEIL_VIEW(scene);
    const uint bundle = packet / NEARLIGHT_BUNDLE_PACKETS;
    const uint place = receiver % BUNDLE_RECEIVERS;
    const uint first = bundle * NEARLIGHT_SHARED_LIST;
    SkyReceiver at;
    at.x = receiver_position(receivers + packet, lane);
    at.n = receiver_normal(receivers + packet, lane);
    at.curve = receiver_curve(receivers + packet, lane);
    at.rays = (float)params.rays;
    at.light_samples = (float)params.light_samples;
    at.bundle_rays = (float)(NEARLIGHT_SKY_RAYS * params.rays);
    const uint max_edges = params.max_edges;
    const uint own_edges = max_edges - min(receiver_surfaces(receivers + packet, lane), max_edges);
    at.max_veils = min(max(own_edges, 1u) - 1, (uint)NEARLIGHT_MAX_VEILS);
    at.seen = seen + receiver;
    at.seen_rays = (float)params.seen_rays;
    at.seen_samples = params.has_seen ? (float)seen[receiver].light_samples : 0.0f;
    const SkyLight light = sum_sky(&scene, &veils, &at, found, listed + first, factors + first,
                                   lengths[bundle], seen_by + first * BUNDLE_WORDS, place);
    add_irradiance_to(irradiance + packet, lane, light.irradiance);
    if (at.seen_samples > 0.0f) {
        vertices[receiver].traced_direct = store3(load3(vertices[receiver].traced_direct) + light.reflected);
    }
}
