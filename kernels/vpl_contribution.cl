// SPDX-License-Identifier: Apache-2.0
// What each VPL brings to the camera: the column sums of the receiver × VPL matrix, over some receivers.
//
// The matrix is symmetric in its geometry, so the gather serves here too, with the roles exchanged: the receivers of
// the camera send out importance like VPLs (importons, host/stages/pilot_view.h), and the VPLs receive it.
// contribution = Σ luminance(response · G · V · power/π) over the importons, response the reflectance (divided by π)
// times the weight of the camera path.
//
// vpl_receivers:    VPL i becomes lane i % 64 of packet i / 64; the last packet is filled up with absent ones.
// vpl_contribution: importance that arrived, and power, to luminance.
// One work-item a lane; any work-group size.

#include "lib/math.cl"

kernel void vpl_receivers(const global Vpl* restrict vpls, uint vpl_count, uint lane_count,
                          global ReceiverPacket* restrict receivers) {
    const uint index = (uint)get_global_id(0);
    if (index >= lane_count) {
        return;
    }
    global ReceiverPacket* packet = receivers + index / NEARLIGHT_PACKET_SIZE;
    const uint lane = index % NEARLIGHT_PACKET_SIZE;
    const bool present = index < vpl_count;
    const float3 position = present ? load3(vpls[index].position) : (float3)(0.0f);
    const float3 normal = present ? load3(vpls[index].normal) : (float3)(0.0f);
    packet->px[lane] = position.x;
    packet->py[lane] = position.y;
    packet->pz[lane] = position.z;
    packet->nx[lane] = normal.x;
    packet->ny[lane] = normal.y;
    packet->nz[lane] = normal.z;
}

kernel void vpl_contribution(const global Vpl* restrict vpls, uint vpl_count,
                             const global IrradiancePacket* restrict importance, global float* restrict contribution) {
    const uint index = (uint)get_global_id(0);
    if (index >= vpl_count) {
        return;
    }
    const global IrradiancePacket* packet = importance + index / NEARLIGHT_PACKET_SIZE;
    const uint lane = index % NEARLIGHT_PACKET_SIZE;
    const float3 arrived = (float3)(packet->r[lane], packet->g[lane], packet->b[lane]);
    contribution[index] = luminance(arrived * load3(vpls[index].power)) * M_1_PI_F;
}
