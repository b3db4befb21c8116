// SPDX-License-Identifier: Apache-2.0
// Light that surfaces reflect other than diffusely, which rays of single receivers find and which all
// receivers of their bundle share.
//
// A receiver's ray meets a place y whose gloss S reflects what arrives from a direction ω, with a density
// that is known for every other receiver, too: that of rays to y (shared_lights.cl), times that of directions
// there, by light samples of y (p_L) and by S as seen from the receiver (p_S). So for each receiver x of the
// bundle
//
//     E(x) ≈ Σ_j L(ω_j→y_j)·S(ω_j, y_j→x)·|cosω_j|·G(x, y_j)·V(x, y_j) / p(y_j, ω_j)
//     p(y, ω) = Σ_s m/π · G(s, y)·V(s, y)·(p_L(ω) + p_S(ω, y→s))
//
// over the finds j that the bundle uses, with the sum over all receivers s that share light of y. Light that
// no sample of lights can bring has p_L = 0, and delta lights have no p_S. What ω brings over further
// surfaces is part of L. Lobes that are narrow beside the neighbourhood of a receiver are left to its own
// rays (shares_gloss); that depends on x and y alone, so nothing is missed or counted twice.
//
// shared_reflection_gather: one work-item for each bundle adds to the irradiance of its receivers. The lists
// are those of shared_lights.cl. Any work-group size.

#include "lib/outlined.cl"
#include "lib/shared_reflection.cl"

/// The surface of a reflection as a receiver sees it towards which `wo` points.
static inline SurfaceBsdf resolve_reflecting(const SceneView* scene, const global SharedReflection* at,
                                             float3 wo) {
    const SurfaceHit hit = surface_met_at(scene, at->triangle, (float2)(at->u, at->v), -wo);
    return surface_bsdf(scene, &hit, -wo, BSDF_RADIANCE, at->model);
}

/// A bundle, and one entry of its list.
typedef struct ReflectionEntry {
    const global ReceiverPacket* packets;  // of the bundle
    const global float* spacing;           // of its receivers
    const global SharedLight* light;
    const global SharedReflection* at;
    const global uint* seen_by;  // the bits of its receivers
} ReflectionEntry;

/// What a reflection brings to the receivers of a bundle.
typedef struct Reflected {
    float3 irradiance[BUNDLE_RECEIVERS];  // for a radiance of 1, times p(y, ω)
    float of_places;                      // Σ_s G·V over all receivers that see y
    float of_paths;                       // Σ_s G·V·(p_L + p_S) over those that share its light
} Reflected;

/// Finds what one reflection brings. All receivers that see it are on the same side of the surface, so that
/// the first of them resolves it for all.
OUTLINED_ON_CPU void reflect_to_all(const SceneView* scene, const ReflectionEntry* entry, Reflected* to) {
    const float3 y = load3(entry->light->position);
    const float3 wi = load3(entry->at->arriving);
    const float light_pdf = entry->at->light_pdf;
    SurfaceBsdf surface;
    float width = -1.0f;  // not known yet
    to->of_places = to->of_paths = 0.0f;
    for (uint lane = 0; lane < BUNDLE_RECEIVERS; ++lane) {
        to->irradiance[lane] = (float3)(0.0f);
        if (!is_seen_by(entry->seen_by, lane)) {
            continue;
        }
        const global ReceiverPacket* packet = entry->packets + lane / NEARLIGHT_PACKET_SIZE;
        const uint i = lane % NEARLIGHT_PACKET_SIZE;
        const float3 x = receiver_position(packet, i);
        const SharedConnection c = connect_shared(entry->light, x, receiver_normal(packet, i), INFINITY);
        to->of_places += c.geometry;
        const float3 wo = normalize(x - y);
        if (width < 0.0f) {
            surface = resolve_reflecting(scene, entry->at, wo);
            width = gloss_width(&surface.bsdf);
        }
        if (shares_gloss(x, y, width, entry->spacing[lane])) {
            surface.wo = wo;
            float pdf;
            const float3 value = bsdf_eval(scene, &surface, wi, BSDF_S, &pdf);
            to->of_paths += c.geometry * (light_pdf < 0.0f ? -light_pdf : light_pdf + pdf);
            to->irradiance[lane] =
                value * (c.geometry * curve_value(scene->curves, receiver_curve(packet, i), c.cos_receiver));
        }
    }
}

kernel void shared_reflection_gather(SCENE_PARAMETERS, const global ReceiverPacket* restrict receivers,
                                     uint packet_count, const global SharedLight* restrict found,
                                     const global SharedReflection* restrict reflections,
                                     const global float* restrict spacing, const global uint* restrict listed,
                                     const global float* restrict factors,
                                     const global uint* restrict lengths, const global uint* restrict seen_by,
                                     global IrradiancePacket* restrict irradiance) {
    const uint index = (uint)get_global_id(0);
    const Bundle bundle = bundle_at(index, packet_count);
    if (bundle.count == 0) {
        return;
    }
    const SceneView scene = SCENE_VIEW;
    const uint first = index * NEARLIGHT_SHARED_LIST;
    Reflected reflected;
    for (uint i = first; i < first + lengths[index]; ++i) {
        const ReflectionEntry entry = {receivers + bundle.first,
                                       spacing + bundle.first * NEARLIGHT_PACKET_SIZE, found + listed[i],
                                       reflections + listed[i], seen_by + i * BUNDLE_WORDS};
        reflect_to_all(&scene, &entry, &reflected);
        if (!(reflected.of_paths > 0.0f)) {
            continue;
        }
        const float3 radiance =
            load3(entry.light->radiance) * (factors[i] * reflected.of_places / reflected.of_paths);
        for (uint lane = 0; lane < bundle.count * NEARLIGHT_PACKET_SIZE; ++lane) {
            add_irradiance_to(irradiance + bundle.first + lane / NEARLIGHT_PACKET_SIZE,
                              lane % NEARLIGHT_PACKET_SIZE, radiance * reflected.irradiance[lane]);
        }
    }
}
