// SPDX-License-Identifier: Apache-2.0
// Light of places behind veils, which rays of single receivers find and which all receivers of their bundle
// share.
//
// VPLs light no receiver through a veil, because veils end the gather's segments. So the Lambertian light
// L_D(y) of a place y behind them comes by rays, at any distance, and bundles share it as they share near
// lights (shared_lights.cl):
//
//     E(x) ≈ Σ_j L_D(y_j)·T(x, y_j)·G(x, y_j)·V(x, y_j) / p(y_j),   p(y) = Σ_s m/π · G(s, y)·V(s, y)
//
// with the transmittance T of the veils between (lib/light/shadow.cl). Rays find places whatever veils let
// through, so that p follows from places alone. V is 1 where nothing but veils is in the way, as many as the
// ray passed that found y: then the light comes over as many edges to all receivers.
//
// shared_veiled_gather: one work-group for each bundle adds to the irradiance of its receivers, which its
// work-items divide. The lists are those of shared_lights.cl, with visibility past solid surfaces. Any
// work-group size.

#include "lib/bundle_light.cl"
#include "lib/light/shadow.cl"
#include "lib/outlined.cl"

/// Lights the receivers `lane`, lane + step, … of a bundle. `packets` are its packets, and `seen_by` has the
/// bits of its receivers.
OUTLINED_ON_CPU void light_receivers(const SceneView* scene, const SceneView* veils,
                                     const global ReceiverPacket* packets, const global SharedLight* light,
                                     const global uint* seen_by, uint lane, uint step,
                                     const BundleLight* to) {
    const float3 y = load3(light->position);
    for (; lane < BUNDLE_RECEIVERS; lane += step) {
        bring_nothing(to, lane);
        if (!is_seen_by(seen_by, lane)) {
            continue;
        }
        const global ReceiverPacket* packet = packets + lane / NEARLIGHT_PACKET_SIZE;
        const uint i = lane % NEARLIGHT_PACKET_SIZE;
        const float3 x = receiver_position(packet, i);
        const SharedConnection c = connect_shared(light, x, receiver_normal(packet, i), INFINITY);
        to->geometry[lane] = c.geometry;
        const Veiling veiling = veiling_between(veils, x, y);
        if (veiling.count == light->veils) {
            to->density[lane] = c.geometry;
            const float transmission = curve_value(scene->curves, light->curve, c.cos_light) *
                                       curve_value(scene->curves, receiver_curve(packet, i), c.cos_receiver);
            to->irradiance[lane] = veiling.part * (c.geometry * transmission);
        }
    }
}

kernel void shared_veiled_gather(SCENE_PARAMETERS, VEIL_PARAMETERS,
                                 const global ReceiverPacket* restrict receivers, uint packet_count,
                                 const global SharedLight* restrict found, const global uint* restrict listed,
                                 const global float* restrict factors, const global uint* restrict lengths,
                                 const global uint* restrict seen_by,
                                 global IrradiancePacket* restrict irradiance, BUNDLE_LIGHT_PARAMETERS) {
    const uint item = (uint)get_local_id(0);
    const uint items = (uint)get_local_size(0);
    const uint index = (uint)get_group_id(0) + (uint)get_global_offset(0) / items;
    const Bundle bundle = bundle_at(index, packet_count);
    const SceneView scene = SCENE_VIEW;
    const SceneView veils = VEIL_VIEW(scene);
    const BundleLight brought = BUNDLE_LIGHT;
    const uint first = index * NEARLIGHT_SHARED_LIST;
    for (uint i = first; i < first + lengths[index]; ++i) {
        const global SharedLight* light = found + listed[i];
        light_receivers(&scene, &veils, receivers + bundle.first, light, seen_by + i * BUNDLE_WORDS, item,
                        items, &brought);
        barrier(CLK_LOCAL_MEM_FENCE);
        add_bundle_light(&brought, load3(light->radiance) * factors[i], &bundle, item, items, irradiance);
        barrier(CLK_LOCAL_MEM_FENCE);
    }
}
