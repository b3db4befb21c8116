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
// shared_reflection_gather: one work-group for each bundle adds to the irradiance of its receivers, which its
// work-items divide. The lists are those of shared_lights.cl. Any work-group size.

#include "lib/bundle_light.cl"
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

/// The first receiver that sees an entry, or BUNDLE_RECEIVERS.
static inline uint first_viewer(const ReflectionEntry* entry) {
    uint lane = 0;
    while (lane < BUNDLE_RECEIVERS && !is_seen_by(entry->seen_by, lane)) {
        ++lane;
    }
    return lane;
}

static inline float3 position_in_bundle(const global ReceiverPacket* packets, uint lane) {
    return receiver_position(packets + lane / NEARLIGHT_PACKET_SIZE, lane % NEARLIGHT_PACKET_SIZE);
}

/// Finds what one reflection brings to the receivers `lane`, lane + step, … of the bundle. All receivers that
/// see it are on the same side of the surface, so that the first of them resolves it for all.
OUTLINED_ON_CPU void reflect_to(const SceneView* scene, const ReflectionEntry* entry, uint lane, uint step,
                                const BundleLight* to) {
    const float3 y = load3(entry->light->position);
    const float3 wi = load3(entry->at->arriving);
    const float light_pdf = entry->at->light_pdf;
    const uint viewer = first_viewer(entry);
    SurfaceBsdf surface;
    float width = 0.0f;
    if (viewer < BUNDLE_RECEIVERS) {
        const float3 wo = normalize(position_in_bundle(entry->packets, viewer) - y);
        surface = resolve_reflecting(scene, entry->at, wo);
        width = gloss_width(&surface.bsdf);
    }
    for (; lane < BUNDLE_RECEIVERS; lane += step) {
        bring_nothing(to, lane);
        if (!is_seen_by(entry->seen_by, lane)) {
            continue;
        }
        const global ReceiverPacket* packet = entry->packets + lane / NEARLIGHT_PACKET_SIZE;
        const uint i = lane % NEARLIGHT_PACKET_SIZE;
        const float3 x = position_in_bundle(entry->packets, lane);
        const SharedConnection c = connect_shared(entry->light, x, receiver_normal(packet, i), INFINITY);
        to->geometry[lane] = c.geometry;
        if (shares_gloss(x, y, width, entry->spacing[lane])) {
            surface.wo = normalize(x - y);
            float pdf;
            const float3 value = bsdf_eval(scene, &surface, wi, BSDF_S, &pdf);
            to->density[lane] = c.geometry * (light_pdf < 0.0f ? -light_pdf : light_pdf + pdf);
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
                                     global IrradiancePacket* restrict irradiance, BUNDLE_LIGHT_PARAMETERS) {
    const uint item = (uint)get_local_id(0);
    const uint items = (uint)get_local_size(0);
    const uint index = (uint)get_group_id(0) + (uint)get_global_offset(0) / items;
    const Bundle bundle = bundle_at(index, packet_count);
    const SceneView scene = SCENE_VIEW;
    const BundleLight brought = BUNDLE_LIGHT;
    const uint first = index * NEARLIGHT_SHARED_LIST;
    for (uint i = first; i < first + lengths[index]; ++i) {
        const ReflectionEntry entry = {receivers + bundle.first,
                                       spacing + bundle.first * NEARLIGHT_PACKET_SIZE, found + listed[i],
                                       reflections + listed[i], seen_by + i * BUNDLE_WORDS};
        reflect_to(&scene, &entry, item, items, &brought);
        barrier(CLK_LOCAL_MEM_FENCE);
        add_bundle_light(&brought, load3(entry.light->radiance) * factors[i], &bundle, item, items,
                         irradiance);
        barrier(CLK_LOCAL_MEM_FENCE);
    }
}
