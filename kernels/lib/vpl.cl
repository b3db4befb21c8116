// SPDX-License-Identifier: Apache-2.0
// VPLs and receivers as kernels write and read them.
#ifndef NEARLIGHT_LIB_VPL
#define NEARLIGHT_LIB_VPL

#include "lib/math.cl"

/// A VPL with the given members; shared/types.h explains `depth` and `flags`. `position` must stand off its
/// surface.
inline Vpl make_vpl(float3 position, float3 normal, uint depth, uint flags, float3 power) {
    Vpl vpl;
    vpl.position = store3(position);
    vpl.depth = depth;
    vpl.normal = store3(normal);
    vpl.flags = flags;
    vpl.power = store3(power);
    vpl.pad0 = 0.0f;
    return vpl;
}

inline float3 receiver_position(const global ReceiverPacket* packet, uint lane) {
    return (float3)(packet->px[lane], packet->py[lane], packet->pz[lane]);
}
/// The normal of a receiver; zero where the receiver is absent.
inline float3 receiver_normal(const global ReceiverPacket* packet, uint lane) {
    return (float3)(packet->nx[lane], packet->ny[lane], packet->nz[lane]);
}

#endif
