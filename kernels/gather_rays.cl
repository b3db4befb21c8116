// SPDX-License-Identifier: Apache-2.0
// Sums a set of VPLs over receivers, for GPUs: a work-item takes one receiver and traces one ray at a time.
// All work-items go through the VPLs in the same order, so those of a work-group ask for the same VPL and for
// neighbouring nodes. gather_packets.cl computes the same on CPUs. host/stages/gatherer.h is the interface of
// both.

#include "lib/bvh_traverse.cl"
#include "lib/curve.cl"
#include "lib/gather.cl"
#include "lib/map_shadowing.cl"
#include "lib/vpl.cl"

/// The geometry term of a VPL and a receiver without visibility, or 0 if there is nothing to trace. `segment`
/// leads from the VPL to the receiver.
static inline float geometry_term(float3 segment, float3 vpl_normal, float3 normal,
                                  float clamp_radius_squared) {
    const float cos_vpl = dot(vpl_normal, segment);
    const float cos_receiver = -dot(normal, segment);
    const float r2 = dot(segment, segment);
    // Each of the cosines still carries a factor r.
    const float term = cos_vpl * cos_receiver / (r2 * fmax(r2, clamp_radius_squared));
    return cos_vpl > 0.0f && cos_receiver > 0.0f && term < INFINITY ? term : 0.0f;
}

/// The product of the transmission curves of both ends of a segment.
static inline float segment_transmission(const global float* curves, const global Vpl* vpl, float3 normal,
                                         uint curve, float3 segment) {
    const float3 direction = normalize(segment);
    return curve_value(curves, vpl_curve(vpl), dot(seen_normal(vpl), direction)) *
           curve_value(curves, curve, -dot(normal, direction));
}

/// By what the surfaces of both ends weigh the light of a segment, besides their cosines. `mesh_normal` is
/// zero where no map tilts the receiver's normal.
static inline float segment_weight(const GatherParams* params, const global float* curves,
                                   const global Vpl* vpl, float3 normal, float3 mesh_normal, uint curve,
                                   float3 segment) {
    const float transmitted =
        params->has_curves ? segment_transmission(curves, vpl, normal, curve, segment) : 1.0f;
    const float unshadowed =
        params->has_maps ? unshadowed_part(normal, mesh_normal, -normalize(segment)) : 1.0f;
    return transmitted * unshadowed;
}

/// The geometry term of a VPL and a receiver, or 0 if the pair is left out whatever stands between: because
/// one of them faces away, a map hides the VPL's surface from there, or its light, which is `scale` times the
/// term, would be below the threshold when squared.
static inline float open_term(const global Vpl* vpl, float3 segment, float3 normal, float3 scale,
                              float clamp_radius_squared, float threshold) {
    const float term = geometry_term(segment, load3(vpl->normal), normal, clamp_radius_squared);
    const bool seen = !is_tilted(vpl) || dot(seen_normal(vpl), segment) > 0.0f;
    const bool open = term > 0.0f && seen && !(term * term * gather_square_scale(vpl, scale) < threshold);
    return open ? term : 0.0f;
}

/// One work-item gathers one receiver of the bundles [first_bundle, end_bundle). Parameters, chunks, groups,
/// thresholds, strata and launches are those of gather_packets.
kernel void gather_rays(const global BvhNode* nodes, const global BvhTriangle* triangles,
                        const global Vpl* vpls, const global ReceiverPacket* receivers,
                        const global GatherParams* launch_params, const global float* thresholds,
                        const global float* curves, const global uint* strata, global IrradiancePacket* sums,
                        global IrradiancePacket* group_sums GATHER_LIST_PARAMETERS GATHER_RECORD_PARAMETERS) {
    const GatherParams params = *launch_params;
    const uint item = (uint)get_global_id(0);
    const uint lane = item % NEARLIGHT_PACKET_SIZE;
    const uint index = params.first_bundle + item / NEARLIGHT_PACKET_SIZE / NEARLIGHT_BUNDLE_PACKETS;
    const uint member = item / NEARLIGHT_PACKET_SIZE % NEARLIGHT_BUNDLE_PACKETS;
    const Bundle bundle = bundle_at(index, params.packet_count);
    if (index >= params.end_bundle || member >= bundle.count) {
        return;
    }
    const uint packet = bundle.first + member;
    const global ReceiverPacket* from = receivers + packet;
    const float3 position = receiver_position(from, lane);
    const float3 normal = receiver_normal(from, lane);
    const float3 mesh_normal = receiver_mesh_normal(from, lane);
    const uint curve = receiver_curve(from, lane);
    global IrradiancePacket* to = sums + packet;
    float3 total = params.first_vpl == 0 ? (float3)0.0f : (float3)(to->r[lane], to->g[lane], to->b[lane]);
    const Stratum stratum = gather_stratum(index, &params, strata);
    const uint end = min(params.end_vpl, GATHER_COUNT(index, &params, &stratum));
    const uint chunk_size = gather_chunk_size(params.group_size);
    const float threshold = params.has_thresholds ? thresholds[packet * NEARLIGHT_PACKET_SIZE + lane] : 0.0f;
    for (uint chunk = params.first_vpl; chunk < end; chunk += chunk_size) {
        float3 sum = (float3)0.0f;
        float3 squares = (float3)0.0f;
        for (uint k = chunk; k < min(chunk + chunk_size, end); ++k) {
            const uint i = GATHER_VPL(index, &params, &stratum, k);
            const global Vpl* vpl = vpls + i;
            const float3 origin = load3(vpl->position);
            const float3 segment = position - origin;
            const float3 scale = gather_scale(vpl) * GATHER_WEIGHT(index, &params, &stratum, k);
            const float term = open_term(vpl, segment, normal, scale, params.clamp_radius_squared, threshold);
            const bool visible = term > 0.0f && !occluded(nodes, triangles, origin, segment,
                                                          NEARLIGHT_SEGMENT_T_MIN, NEARLIGHT_SEGMENT_T_MAX);
            const float weight =
                visible ? term * segment_weight(&params, curves, vpl, normal, mesh_normal, curve, segment)
                        : 0.0f;
            sum += scale * (gather_squared(vpl) ? weight * weight : weight);
            squares += scale * scale * (weight * weight);
#ifdef GATHER_RECORD
            const uchar traced = visible ? NEARLIGHT_PAIR_VISIBLE : NEARLIGHT_PAIR_OCCLUDED;
            record[gather_record_index(packet, i, params.vpl_count, lane)] =
                term > 0.0f ? traced : NEARLIGHT_PAIR_CULLED;
#endif
        }
        total += params.group_size != 0 ? squares : sum;
        if (params.group_size != 0) {
            store_irradiance(group_sums + (size_t)(chunk / params.group_size) * params.packet_count + packet,
                             lane, sum);
        }
    }
    store_irradiance(to, lane, total);
}
