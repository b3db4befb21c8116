// SPDX-License-Identifier: Apache-2.0
// Which receivers of a bundle see each of its shared lights (shared_lights.cl), for CPUs: the receivers of a
// beam go through the wide tree together, as in gather_packets.cl. shared_light_rays.cl finds the same on
// GPUs.

#include "lib/shared_light.cl"
#include "lib/wide_traverse.cl"

/// Sets one bit of a row for each lane whose receiver shares lights. Lane i has receiver first + order[i] of
/// the bundle.
static inline void find_sharing_lanes(uint* sharing, const global ReceiverPacket* packets,
                                      const Bundle* bundle, uint first, const uchar* order, uint max_edges) {
    for (uint row = 0; row < GATHER_ROWS; ++row) {
        sharing[row] = 0;
        for (uint i = 0; i < 16; ++i) {
            const uint lane = first + order[16 * row + i];
            sharing[row] |= (bundle_receiver_shares(packets, bundle, lane, max_edges) ? 1u : 0u) << i;
        }
    }
}

/// Ends the segments to receivers that do not share, and to those whose rays could not have found the light.
static inline void leave_out_strangers(Segments* s, const global SharedLight* light, const uint* sharing,
                                       float max_distance_squared) {
    const float3 shading = unpack_direction(light->shading);
    for (uint open = s->open; open != 0; open &= ~clusters_of_row(first_row(open))) {
        const uint row = first_row(open);
        const float16 dx = s->dx[row], dy = s->dy[row], dz = s->dz[row];
        const int16 near = (dx * dx + dy * dy + dz * dz < max_distance_squared) &
                           (shading.x * dx + shading.y * dy + shading.z * dz > 0.0f);
        end_lanes(s, row, ~(lane_bits16(near) & sharing[row]));
    }
}

/// Sets the bits of the receivers that see the light. Adds up their geometry terms in the order of the
/// receivers, so that the sum does not depend on the width of beams.
static inline float add_seen(const Segments* s, const uchar* order, uint first, float sum,
                             global uint* seen_by) {
    float terms[GATHER_BEAM_WIDTH];
    for (uint i = 0; i < GATHER_BEAM_WIDTH; ++i) {
        terms[i] = 0.0f;
    }
    for (uint open = s->open; open != 0; open &= ~clusters_of_row(first_row(open))) {
        const uint row = first_row(open);
        for (uint lanes = s->lanes[row]; lanes != 0; lanes &= lanes - 1) {
            const uint i = 16 * row + lowest_bit(lanes);
            const uint lane = first + order[i];
            seen_by[lane / 32] |= 1u << lane % 32;
            terms[order[i]] = ((const float*)s->weight)[i];
        }
    }
    for (uint i = 0; i < GATHER_BEAM_WIDTH; ++i) {
        sum += terms[i];
    }
    return sum;
}

/// Does for all bundles what shared_light_rays does. Work-items take one bundle after another from a queue
/// until none is left; `next_bundle` must be 0 at the start.
kernel __attribute__((reqd_work_group_size(1, 1, 1))) void shared_light_packets(
    const global WideNode* nodes, const global TriangleBlock* blocks,
    const global ReceiverPacket* restrict receivers, uint packet_count,
    const global SharedLight* restrict found, float max_distance_squared, uint max_edges,
    uint rays_per_receiver, const global uint* restrict listed, const global uint* restrict lengths,
    global float* restrict factors, global uint* restrict seen_by, volatile global uint* next_bundle) {
    Receivers beam;
    BeamBounds bounds;
    Segments segments;
    uint sharing[GATHER_ROWS];
    float sums[NEARLIGHT_SHARED_LIST];
    const uint count = (packet_count + NEARLIGHT_BUNDLE_PACKETS - 1) / NEARLIGHT_BUNDLE_PACKETS;
    for (uint index = atomic_inc(next_bundle); index < count; index = atomic_inc(next_bundle)) {
        const Bundle bundle = bundle_at(index, packet_count);
        const uint length = lengths[index];
        const uint list = index * NEARLIGHT_SHARED_LIST;
        for (uint i = 0; i < length; ++i) {
            sums[i] = 0.0f;
        }
        for (uint i = 0; i < length * BUNDLE_WORDS; ++i) {
            seen_by[list * BUNDLE_WORDS + i] = 0;
        }
        for (uint first = 0; length > 0 && first < BUNDLE_RECEIVERS; first += GATHER_BEAM_WIDTH) {
            gather_receivers(&beam, &bounds, receivers, &bundle, first);
            find_sharing_lanes(sharing, receivers, &bundle, first, beam.order, max_edges);
            for (uint i = 0; i < length; ++i) {
                const global SharedLight* light = found + listed[list + i];
                connect(&segments, as_vpl(light), &beam, 0.0f);
                leave_out_strangers(&segments, light, sharing, max_distance_squared);
                trace_segments(&segments, &bounds, nodes, blocks);
                sums[i] =
                    add_seen(&segments, beam.order, first, sums[i], seen_by + (list + i) * BUNDLE_WORDS);
            }
        }
        for (uint i = 0; i < length; ++i) {
            factors[list + i] = shared_factor(factors[list + i], sums[i], rays_per_receiver);
        }
    }
}
