// SPDX-License-Identifier: Apache-2.0
// What each VPL brings to the camera: the column sums of the receiver × VPL matrix, over some receivers.
//
// Shading normals of VPLs do not count here, nor do coats of receivers for the light that arrives. Without
// them the matrix is symmetric in its geometry, so the gather serves here too, with the roles exchanged: the
// receivers of the camera send out importance as VPLs send light (importons, host/stages/pilot_view.h), and
// the VPLs receive it through their coats. The sums are over the importons, and `response` is
// Importon.response:
// - With squared = 0, it is Σ luminance(response/π · G · V · power/π), which the VPL brings.
// - With squared = 1, it is the root of Σ |response/π · G · V · power/π|² over R, G, B. If VPLs are chosen by
//   chance, the error of the picture is smallest when the probabilities follow this. The importance must be
//   that of squares.
// - `vpl_group_contribution` keeps the three channels for each group of importons (a part of the picture):
//   scale · Σ response/π · G · V · power/π over the group, in slot (VPL · group_count + group) · 3 + channel.
// One work-item for each VPL, or for each VPL and group; any work-group size.
//
// `importance_thresholds` says before the gather which importons are not worth a ray, because few make up
// nearly all of the error that a VPL would leave.

#include "lib/math.cl"
#include "lib/vpl_terms.cl"

static inline float3 arrived_importance(const global ImportancePacket* importance, uint vpl) {
    const global ImportancePacket* packet = importance + vpl / NEARLIGHT_PACKET_SIZE;
    const uint lane = vpl % NEARLIGHT_PACKET_SIZE;
    return (float3)(packet->r[lane], packet->g[lane], packet->b[lane]);
}

kernel void vpl_contribution(const global Vpl* restrict vpls, uint vpl_count,
                             const global ImportancePacket* restrict importance, uint squared,
                             global float* restrict contribution) {
    const uint index = (uint)get_global_id(0);
    if (index >= vpl_count) {
        return;
    }
    const float3 arrived = arrived_importance(importance, index);
    const float3 power = load3(vpls[index].power);
    contribution[index] =
        squared ? sqrt(dot(arrived, power * power)) * M_1_PI_F : luminance(arrived * power) * M_1_PI_F;
}

kernel void vpl_group_contribution(const global Vpl* restrict vpls, uint vpl_count,
                                   const global ImportancePacket* restrict group_importance, uint group_count,
                                   float scale, global float* restrict contribution) {
    const size_t slot = get_global_id(0);
    const uint index = (uint)(slot / group_count);
    const uint group = (uint)(slot % group_count);
    if (index >= vpl_count) {
        return;
    }
    const uint packet_count = (vpl_count + NEARLIGHT_PACKET_SIZE - 1) / NEARLIGHT_PACKET_SIZE;
    const global ImportancePacket* of_group = group_importance + (size_t)group * packet_count;
    const float3 brought = arrived_importance(of_group, index) * load3(vpls[index].power);
    vstore3(brought * (scale * M_1_PI_F), slot, contribution);
}

/// An importon as the gather reads it. The struct Importon in shared/types.h has the members of a Vpl in the
/// same places.
static inline const global Vpl* as_source(const global Importon* importon) {
    return (const global Vpl*)importon;
}

/// Sets thresholds[i] to `part` times the mean, over the importons, of the squares of the importance that
/// would arrive at receiver i of the packets if nothing were in the way. One work-item for each row of 16
/// receivers.
kernel void importance_thresholds(const global Importon* restrict importons, uint importon_count,
                                  const global ReceiverPacket* restrict receivers, uint packet_count,
                                  float clamp_radius_squared, float part, global float* restrict thresholds) {
    const uint item = (uint)get_global_id(0);
    const uint packet = item / (NEARLIGHT_PACKET_SIZE / 16);
    const uint row = item % (NEARLIGHT_PACKET_SIZE / 16);
    if (packet >= packet_count) {
        return;
    }
    float16 squares = (float16)0.0f;
    for (uint i = 0; i < importon_count; ++i) {
        const global Vpl* importon = as_source(importons + i);
        const float square_scale = gather_square_scale(importon, gather_scale(importon));
        squares += square_scale * squared_terms(importon, receivers + packet, row, clamp_radius_squared);
    }
    vstore16(squares * (part / (float)importon_count), item, thresholds);
}
