// SPDX-License-Identifier: Apache-2.0
// VPLs as receivers of light, and what they reflect of it.
//
// - vpl_receivers: VPL i becomes lane i % 64 of packet i / 64, with the normal by which its surface receives
//   light or, if `emits` is 1, the one by which it sends light out. The last packet is filled up with absent
//   receivers. Under a map, the face's normal stands for the mesh's interpolated one, which VPLs do not keep
//   (docs/method.md, "Maps").
// - vpl_light: the power of VPL i is multiplied by the irradiance of its lane. A VPL made for an irradiance
//   of 1 W/m², whose power is the albedo times the area that it stands for, so gets the power that the light
//   there gives it [paper eq. 2, repaired: angle and distance are to the light].
// - add_irradiance: adds one set of packets to another.
// One work-item for each lane or VPL; any work-group size.

#include "lib/vpl.cl"

kernel void vpl_receivers(const global Vpl* restrict vpls, uint vpl_count, uint lane_count, uint emits,
                          global ReceiverPacket* restrict receivers) {
    const uint index = (uint)get_global_id(0);
    if (index >= lane_count) {
        return;
    }
    global ReceiverPacket* packet = receivers + index / NEARLIGHT_PACKET_SIZE;
    const uint lane = index % NEARLIGHT_PACKET_SIZE;
    const bool present = index < vpl_count;
    const float3 position = present ? load3(vpls[index].position) : (float3)(0.0f);
    const float3 geometric = present ? load3(vpls[index].normal) : (float3)(0.0f);
    const bool is_real = present && dot(geometric, geometric) > 0.0f;
    const float3 normal = is_real && !emits ? unpack_direction(vpls[index].shading) : geometric;
    packet->px[lane] = position.x;
    packet->py[lane] = position.y;
    packet->pz[lane] = position.z;
    packet->nx[lane] = normal.x;
    packet->ny[lane] = normal.y;
    packet->nz[lane] = normal.z;
    packet->surface[lane] = present ? vpl_curve(vpls + index) : 0;
    const bool is_mapped = is_real && !emits && (vpls[index].flags & NEARLIGHT_VPL_MAPPED);
    packet->mesh_normal[lane] = is_mapped ? pack_mesh_normal(geometric) : 0;
    packet->sequence[lane] = 0;
}

kernel void vpl_light(global Vpl* restrict vpls, uint vpl_count,
                      const global IrradiancePacket* restrict irradiance) {
    const uint index = (uint)get_global_id(0);
    if (index >= vpl_count) {
        return;
    }
    const global IrradiancePacket* packet = irradiance + index / NEARLIGHT_PACKET_SIZE;
    const uint lane = index % NEARLIGHT_PACKET_SIZE;
    vpls[index].power.x *= packet->r[lane];
    vpls[index].power.y *= packet->g[lane];
    vpls[index].power.z *= packet->b[lane];
}

kernel void add_irradiance(const global IrradiancePacket* restrict more, uint lane_count,
                           global IrradiancePacket* restrict irradiance) {
    const uint index = (uint)get_global_id(0);
    if (index >= lane_count) {
        return;
    }
    const uint packet = index / NEARLIGHT_PACKET_SIZE;
    const uint lane = index % NEARLIGHT_PACKET_SIZE;
    irradiance[packet].r[lane] += more[packet].r[lane];
    irradiance[packet].g[lane] += more[packet].g[lane];
    irradiance[packet].b[lane] += more[packet].b[lane];
}
