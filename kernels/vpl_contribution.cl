// SPDX-License-Identifier: Apache-2.0
// What each VPL brings to the camera: the column sums of the receiver × VPL matrix, over some receivers.
//
// One work-item a VPL; any work-group size. contribution = Σ luminance(response · G · V · power/π) over the
// receivers of `packet_count` packets, response the reflectance (divided by π) times the weight of the camera path.
// Used by the pilot that splits the budget.

#include "lib/bvh_traverse.cl"

kernel void vpl_contribution(const global BvhNode* restrict nodes, const global BvhTriangle* restrict triangles,
                             const global Vpl* restrict vpls, uint vpl_count,
                             const global ReceiverPacket* restrict receivers,
                             const global CameraVertex* restrict vertices, uint packet_count, float clamp_radius,
                             global float* restrict contribution) {
    const uint index = (uint)get_global_id(0);
    if (index >= vpl_count) {
        return;
    }
    const Vpl vpl = vpls[index];
    const float3 y = load3(vpl.position);
    const float3 n_y = load3(vpl.normal);
    const float3 power = load3(vpl.power);
    float sum = 0.0f;
    for (uint i = 0; i < packet_count * NEARLIGHT_PACKET_SIZE; ++i) {
        const global ReceiverPacket* packet = receivers + i / NEARLIGHT_PACKET_SIZE;
        const uint lane = i % NEARLIGHT_PACKET_SIZE;
        const float3 d = (float3)(packet->px[lane], packet->py[lane], packet->pz[lane]) - y;
        const float3 n_x = (float3)(packet->nx[lane], packet->ny[lane], packet->nz[lane]);
        const float cos_x = -dot(n_x, d);
        const float cos_y = dot(n_y, d);
        if (!(cos_x > 0.0f) || !(cos_y > 0.0f)) {
            continue;
        }
        const float squared = dot(d, d);
        const float3 response = load3(vertices[i].throughput) * load3(vertices[i].albedo);
        const float geometry = cos_x * cos_y / (squared * fmax(squared, clamp_radius * clamp_radius));
        const float value = luminance(response * power) * geometry / (M_PI_F * M_PI_F);
        if (value > 0.0f && !occluded(nodes, triangles, y, d, NEARLIGHT_SEGMENT_T_MIN, NEARLIGHT_SEGMENT_T_MAX)) {
            sum += value;
        }
    }
    contribution[index] = sum;
}
