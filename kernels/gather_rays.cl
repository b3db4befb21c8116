// SPDX-License-Identifier: Apache-2.0
// Sums a VPL set over receivers, for GPUs: one work-item takes one receiver, one ray at a time. All
// work-items go through the VPLs in the same order, so those of a group ask for the same VPL and for
// neighbouring nodes. gather_packets.cl computes the same on CPUs. host/stages/gatherer.h is the interface of
// both.

#include "lib/bvh_traverse.cl"
#include "lib/gather.cl"
#include "lib/vpl.cl"

/// Geometry term of VPL and receiver without visibility, 0 if there is nothing to trace: `segment` leads from
/// the VPL to the receiver.
inline float geometry_term(float3 segment, float3 vpl_normal, float3 normal, float clamp_radius_squared) {
    const float cos_vpl = dot(vpl_normal, segment);
    const float cos_receiver = -dot(normal, segment);
    const float r2 = dot(segment, segment);
    // Both cosines still carry a factor r.
    const float term = cos_vpl * cos_receiver / (r2 * fmax(r2, clamp_radius_squared));
    return cos_vpl > 0.0f && cos_receiver > 0.0f && term < INFINITY ? term : 0.0f;
}

inline void store_irradiance(global IrradiancePacket* to, uint lane, float3 sum) {
    to->r[lane] = sum.x;
    to->g[lane] = sum.y;
    to->b[lane] = sum.z;
}

/// One work-item for each receiver of the bundles [first_bundle, end_bundle), over the VPLs [first_vpl,
/// end_vpl). Chunks, groups, what is left out, and launches as in gather_packets.
kernel void gather_rays(
    const global BvhNode* nodes, const global BvhTriangle* triangles, const global Vpl* vpls, uint first_vpl,
    uint end_vpl, const global ReceiverPacket* receivers, uint packet_count, uint run_packets,
    uint first_bundle, uint end_bundle, float clamp_radius_squared, uint group_size,
    const global float* least, uint has_least,
    global IrradiancePacket* irradiance GATHER_ROULETTE_PARAMETERS GATHER_RECORD_PARAMETERS) {
    const uint item = (uint)get_global_id(0);
    const uint lane = item % NEARLIGHT_PACKET_SIZE;
    const uint index = first_bundle + item / NEARLIGHT_PACKET_SIZE / NEARLIGHT_BUNDLE_PACKETS;
    const uint member = item / NEARLIGHT_PACKET_SIZE % NEARLIGHT_BUNDLE_PACKETS;
    const Bundle bundle = bundle_at(index, packet_count, run_packets);
    if (index >= end_bundle || member >= bundle.count) {
        return;
    }
    const uint packet = bundle.first + member;
    const global ReceiverPacket* from = receivers + packet;
    const float3 position = receiver_position(from, lane);
    const float3 normal = receiver_normal(from, lane);
    global IrradiancePacket* to = irradiance + packet;
    float3 total = first_vpl == 0 ? (float3)0.0f : (float3)(to->r[lane], to->g[lane], to->b[lane]);
    const uint end = GATHER_END(index, end_vpl);
    const uint chunk_size = gather_chunk_size(group_size);
    const float least_square = has_least ? least[packet * NEARLIGHT_PACKET_SIZE + lane] : 0.0f;
    for (uint chunk = first_vpl; chunk < end; chunk += chunk_size) {
        float3 sum = (float3)0.0f;
        float3 squares = (float3)0.0f;
        for (uint k = chunk; k < min(chunk + chunk_size, end); ++k) {
            const uint i = GATHER_VPL(index, k);
            const global Vpl* vpl = vpls + i;
            const float3 origin = load3(vpl->position);
            const float3 segment = position - origin;
            const float term = geometry_term(segment, load3(vpl->normal), normal, clamp_radius_squared);
            const float3 scale = gather_scale(vpl) * GATHER_WEIGHT(index, k);
            const bool open = term > 0.0f && !(term * term * gather_square_scale(vpl, scale) < least_square);
            const bool visible = open && !occluded(nodes, triangles, origin, segment, NEARLIGHT_SEGMENT_T_MIN,
                                                   NEARLIGHT_SEGMENT_T_MAX);
            sum += visible ? scale * (gather_squared(vpl) ? term * term : term) : (float3)0.0f;
            squares += visible ? scale * scale * (term * term) : (float3)0.0f;
#ifdef GATHER_RECORD
            record[gather_record_index(packet, i, record_vpl_count, lane)] = !open ? 0
                                                                             : visible
                                                                                 ? GATHER_RECORD_VISIBLE
                                                                                 : GATHER_RECORD_OCCLUDED;
#endif
        }
        total += group_size != 0 ? squares : sum;
        if (group_size != 0) {
            store_irradiance(to + gather_slot(chunk, group_size, packet_count), lane, sum);
        }
    }
    store_irradiance(to, lane, total);
}
