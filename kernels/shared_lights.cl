// SPDX-License-Identifier: Apache-2.0
// Shared lights: what a ray of one receiver finds lights all receivers of its bundle [Bekaert, Sbert &
// Halton, Accelerating Path Tracing by Re-Using Paths, 2002; Davidovič et al., Combining Global and Local
// Virtual Lights for Detailed Glossy Illumination, 2010].
//
// The Lambertian light L_D that a gather with the clamp radius R leaves out at a receiver x is
// ∫ L_D(y)·(1 − r²/R²)·G(x, y)·V(x, y) dy over the places y nearer than R (lib/receiver_path.cl). Each
// receiver s of a bundle that shares sends m cosine-distributed rays, and where one lands there is a light
// y_j. For each of these receivers
//
//     E(x) ≈ Σ_j L_D(y_j)·(1 − r²/R²)·G(x, y_j)·V(x, y_j) / p(y_j),   p(y) = Σ_s m/π · G(s, y)·V(s, y)
//
// where p is the density of all rays of the bundle together (the balance heuristic over its receivers). No
// term exceeds π·L_D/m, because the rays of x alone make p ≥ m/π·G·V. A receiver keeps one light of those
// that its rays find (lib/shared_light.cl), and a bundle uses NEARLIGHT_SHARED_LIGHTS of those that its
// receivers keep; both count 1/probability. The draws follow SharedLight.weight, which is the radiance times
// max(1 − r²/R², 0.05) with the r of the receiver that found the light (lib/receiver_path.cl).
//
// - shared_light_choose: one work-item for each bundle lists the lights that it uses.
// - shared_light_packets, shared_light_rays (files of their own): which receivers see them, and p.
// - shared_light_gather: one work-item for each receiver adds what the lights of its bundle bring.
// Any work-group size. The list of bundle b is entries b · NEARLIGHT_SHARED_LIST + [0, lengths[b]).

#include "lib/curve.cl"
#include "lib/shared_light.cl"

/// Lists about `wanted` lights of each bundle, with 1/probability as their factors. `purpose` gives each kind
/// of lights random numbers of its own.
kernel void shared_light_choose(const global ReceiverPacket* restrict receivers, uint packet_count,
                                const global SharedLight* restrict found, uint wanted, uint seed,
                                uint purpose, global uint* restrict listed, global float* restrict factors,
                                global uint* restrict lengths) {
    const uint index = (uint)get_global_id(0);
    const Bundle bundle = bundle_at(index, packet_count);
    if (bundle.count == 0) {
        return;
    }
    const uint first = bundle.first * NEARLIGHT_PACKET_SIZE;
    const uint end = first + bundle.count * NEARLIGHT_PACKET_SIZE;
    float total = 0.0f;
    for (uint i = first; i < end; ++i) {
        total += found[i].weight;
    }
    const float per_weight = total > 0.0f ? (float)wanted / total : 0.0f;
    float place = total > 0.0f ? bundle_number(receivers, &bundle, seed, purpose) : 0.0f;
    uint length = 0;
    for (uint i = first; i < end; ++i) {
        const float p = fmin(1.0f, found[i].weight * per_weight);
        place += p;
        if (p > 0.0f && place >= 1.0f && length < NEARLIGHT_SHARED_LIST) {
            place -= 1.0f;
            listed[index * NEARLIGHT_SHARED_LIST + length] = i;
            factors[index * NEARLIGHT_SHARED_LIST + length] = 1.0f / p;
            ++length;
        }
    }
    lengths[index] = length;
}

kernel void shared_light_gather(const global ReceiverPacket* restrict receivers, uint packet_count,
                                const global SharedLight* restrict found, const global float* restrict curves,
                                float clamp_radius_squared, const global uint* restrict listed,
                                const global float* restrict factors, const global uint* restrict lengths,
                                const global uint* restrict seen_by,
                                global IrradiancePacket* restrict irradiance) {
    const uint receiver = (uint)get_global_id(0);
    const uint packet = receiver / NEARLIGHT_PACKET_SIZE;
    const uint lane = receiver % NEARLIGHT_PACKET_SIZE;
    if (packet >= packet_count) {
        return;
    }
    const uint bundle = packet / NEARLIGHT_BUNDLE_PACKETS;
    const uint place = receiver % BUNDLE_RECEIVERS;
    const float3 x = receiver_position(receivers + packet, lane);
    const float3 n = receiver_normal(receivers + packet, lane);
    const uint curve = receiver_curve(receivers + packet, lane);
    const uint first = bundle * NEARLIGHT_SHARED_LIST;
    float3 sum = (float3)(0.0f);
    for (uint entry = first; entry < first + lengths[bundle]; ++entry) {
        if (is_seen_by(seen_by + entry * BUNDLE_WORDS, place)) {
            const global SharedLight* light = found + listed[entry];
            const SharedConnection c = connect_shared(light, x, n, clamp_radius_squared);
            const float transmission =
                curve_value(curves, light->curve, c.cos_light) * curve_value(curves, curve, c.cos_receiver);
            sum += load3(light->radiance) * (factors[entry] * c.part * c.geometry * transmission);
        }
    }
    add_irradiance_to(irradiance + packet, lane, sum);
}
