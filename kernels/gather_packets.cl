// SPDX-License-Identifier: Apache-2.0
// Sums a VPL set over receivers, for CPUs: irradiance E(x) = Σ power/π · max0(cosθx)·max0(cosθy)/max(r², R²) · V.
//
// One work-item takes one packet of receivers against a run of VPLs. The compiler does not turn a divergent
// traversal loop into vector code, so the vectors are written out: a packet is GATHER_GROUPS groups of 16
// lanes that go through the wide tree together. What makes this fast:
// - All rays of a packet start at the VPL, so box − origin is the same for all lanes, and the triangle test is
//   three dot products a lane with constants of the (VPL, triangle) pair, without a division.
// - A node tests its eight children at once against the shaft from the VPL to the box of the receivers. Only
//   what meets the shaft is tested lane by lane, when its turn comes.
// - An inner node is entered as soon as one group meets its box, and remembers that group: the groups before it
//   need not be looked at again below [Overbeck et al., Large Ray Packets for Real-time Whitted Ray Tracing,
//   2008]. A leaf notes which groups meet it.
// - A block's four triangles are tested at once against the shaft before any lane is.
// - A lane that is culled or occluded has t_max = −1, which no box and no triangle passes: no other mask is kept.
//
// gather_rays.cl computes the same on GPUs. host/stages/gatherer.h is the interface of both.

#include "lib/bvh_traverse.cl"

#include "lib/gather.cl"
#include "lib/wide_traverse.cl"

typedef struct Accumulator {
    float16 r[GATHER_GROUPS], g[GATHER_GROUPS], b[GATHER_GROUPS];
} Accumulator;


#ifdef GATHER_RECORD
inline void record_open(const Segments* s, global uchar* record) {
    for (uint group = 0; group < GATHER_GROUPS; ++group) {
        const int16 open = s->t_max[group] > 0.0f;
        vstore16(convert_uchar16(open & (int)GATHER_RECORD_VISIBLE), group, record);
    }
}
inline void record_occluded(const Segments* s, global uchar* record) {
    for (uint group = 0; group < GATHER_GROUPS; ++group) {
        const uchar16 traced = vload16(group, record);
        const uchar16 occluded = convert_uchar16((s->t_max[group] < 0.0f) & (int)GATHER_RECORD_OCCLUDED);
        vstore16(traced != (uchar16)0 ? max(traced, occluded) : traced, group, record);
    }
}
#endif

inline void add_visible(Accumulator* sum, const Segments* s, float3 scale, bool squared) {
    for (uint group = 0; group < GATHER_GROUPS; ++group) {
        const float16 term = s->t_max[group] > 0.0f ? s->weight[group] : (float16)0.0f;
        const float16 weight = squared ? term * term : term;
        sum->r[group] += scale.x * weight;
        sum->g[group] += scale.y * weight;
        sum->b[group] += scale.z * weight;
    }
}

inline void clear(Accumulator* sum) {
    for (uint group = 0; group < GATHER_GROUPS; ++group) {
        sum->r[group] = sum->g[group] = sum->b[group] = (float16)0.0f;
    }
}

/// irradiance (+)= sum, where `replace` says not to add.
inline void add_to_irradiance(global IrradiancePacket* irradiance, uint first_lane, const Accumulator* sum,
                              bool replace) {
    for (uint group = 0; group < GATHER_GROUPS; ++group) {
        const uint at = first_lane / 16 + group;
        const float16 none = (float16)0.0f;
        vstore16(sum->r[group] + (replace ? none : vload16(at, irradiance->r)), at, irradiance->r);
        vstore16(sum->g[group] + (replace ? none : vload16(at, irradiance->g)), at, irradiance->g);
        vstore16(sum->b[group] + (replace ? none : vload16(at, irradiance->b)), at, irradiance->b);
    }
}

/// One work-item for each GATHER_PACKET_WIDTH receivers of the packets [first_packet, end_packet), over the
/// VPLs [first_vpl, end_vpl). Each GATHER_CHUNK of VPLs, counted from VPL 0, is summed by itself and then
/// added to the irradiance, so that the result does not depend on how launches divide the work; first_vpl
/// must be a multiple of GATHER_CHUNK. Launches over the VPLs of one packet must follow one another in order,
/// from 0.
kernel __attribute__((reqd_work_group_size(1, 1, 1))) void gather_packets(
    const global WideNode* nodes, const global TriangleBlock* blocks, const global Vpl* vpls, uint first_vpl,
    uint end_vpl, const global ReceiverPacket* receivers, uint first_packet, uint end_packet,
    float clamp_radius_squared, global IrradiancePacket* irradiance GATHER_ROULETTE_PARAMETERS
        GATHER_RECORD_PARAMETERS) {
    const uint item = (uint)get_global_id(0);
    const uint packet = first_packet + item / (NEARLIGHT_PACKET_SIZE / GATHER_PACKET_WIDTH);
    const uint first_lane = item % (NEARLIGHT_PACKET_SIZE / GATHER_PACKET_WIDTH) * GATHER_PACKET_WIDTH;
    if (packet >= end_packet) {
        return;
    }
    const PacketBounds bounds = bounds_of(receivers + packet, first_lane);
    Segments segments;
    Accumulator sum;
    const uint end = GATHER_END(packet, end_vpl);
    for (uint chunk = first_vpl; chunk < end || chunk == 0; chunk += GATHER_CHUNK) {
        clear(&sum);
        for (uint k = chunk; k < min(chunk + GATHER_CHUNK, end); ++k) {
            const uint i = GATHER_VPL(packet, k);
            connect(&segments, vpls + i, receivers + packet, first_lane, clamp_radius_squared);
#ifdef GATHER_RECORD
            global uchar* pairs = record + gather_record_index(packet, i, record_vpl_count, first_lane);
            record_open(&segments, pairs);
#endif
            test_visibility(&segments, &bounds, nodes, blocks);
#ifdef GATHER_RECORD
            record_occluded(&segments, pairs);
#endif
            add_visible(&sum, &segments, gather_scale(vpls + i) * GATHER_WEIGHT(packet, k),
                        gather_squared(vpls + i));
        }
        add_to_irradiance(irradiance + packet, first_lane, &sum, chunk == 0);
    }
}
