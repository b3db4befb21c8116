// SPDX-License-Identifier: Apache-2.0
// Which receivers of a bundle see each of its shared lights (shared_lights.cl), for GPUs: a work-item takes
// one light and traces one ray at a time. shared_light_packets.cl finds the same on CPUs.

#include "lib/bvh_traverse.cl"
#include "lib/shared_light.cl"

/// One work-item for each entry of the lists. Sets the bit of each receiver of the bundle that shares and
/// sees the light, and turns the entry's 1/probability into its shared_factor(). Any work-group size.
kernel void shared_light_rays(const global BvhNode* nodes, const global BvhTriangle* triangles,
                              const global ReceiverPacket* restrict receivers, uint packet_count,
                              const global SharedLight* restrict found, float max_distance_squared,
                              uint max_edges, uint rays_per_receiver, const global uint* restrict listed,
                              const global uint* restrict lengths, global float* restrict factors,
                              global uint* restrict seen_by) {
    const uint entry = (uint)get_global_id(0);
    const uint index = entry / NEARLIGHT_SHARED_LIST;
    const Bundle bundle = bundle_at(index, packet_count);
    if (bundle.count == 0 || entry % NEARLIGHT_SHARED_LIST >= lengths[index]) {
        return;
    }
    const global SharedLight* light = found + listed[entry];
    const float3 from = load3(light->position);
    float sum = 0.0f;
    for (uint word = 0; word < BUNDLE_WORDS; ++word) {
        uint seen = 0;
        for (uint bit = 0; bit < 32; ++bit) {
            const uint lane = 32 * word + bit;
            if (!bundle_receiver_shares(receivers, &bundle, lane, max_edges)) {
                continue;
            }
            const global ReceiverPacket* packet = receivers + bundle.first + lane / NEARLIGHT_PACKET_SIZE;
            const float3 x = receiver_position(packet, lane % NEARLIGHT_PACKET_SIZE);
            const float3 n = receiver_normal(packet, lane % NEARLIGHT_PACKET_SIZE);
            const SharedConnection c = connect_shared(light, x, n, max_distance_squared);
            if (c.geometry > 0.0f && !occluded(nodes, triangles, from, x - from, NEARLIGHT_SEGMENT_T_MIN,
                                               NEARLIGHT_SEGMENT_T_MAX)) {
                sum += c.geometry;
                seen |= 1u << bit;
            }
        }
        seen_by[entry * BUNDLE_WORDS + word] = seen;
    }
    factors[entry] = shared_factor(factors[entry], sum, rays_per_receiver);
}
