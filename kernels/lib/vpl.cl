// SPDX-License-Identifier: Apache-2.0
// VPLs and receivers as kernels write and read them.
#ifndef NEARLIGHT_LIB_VPL
#define NEARLIGHT_LIB_VPL

#include "lib/math.cl"

/// A VPL with the given members; shared/types.h explains `depth` and `flags`. `position` must stand off its
/// surface, `shading` is the normal by which the surface is shaded, and `curve` the row of its transmission
/// curve.
static inline Vpl make_vpl(float3 position, float3 normal, float3 shading, uint curve, uint depth, uint flags,
                           float3 power) {
    Vpl vpl;
    vpl.position = store3(position);
    vpl.depth = depth;
    vpl.normal = store3(normal);
    // Rounding alone leaves a cosine nearer to 1.
    const uint tilted = dot(shading, normal) < 0.999999f ? NEARLIGHT_VPL_TILTED : 0u;
    vpl.flags = flags | tilted | curve << NEARLIGHT_VPL_CURVE_SHIFT;
    vpl.power = store3(power);
    vpl.shading = pack_direction(shading);
    return vpl;
}

static inline uint vpl_curve(const global Vpl* vpl) {
    return vpl->flags >> NEARLIGHT_VPL_CURVE_SHIFT;
}

/// Whether the light that a VPL sends out depends on the shading normal.
static inline bool is_tilted(const global Vpl* vpl) {
    return (vpl->flags & NEARLIGHT_VPL_TILTED) != 0;
}
/// The normal by whose side and angle a VPL is seen.
static inline float3 seen_normal(const global Vpl* vpl) {
    return is_tilted(vpl) ? unpack_direction(vpl->shading) : load3(vpl->normal);
}

static inline float3 receiver_position(const global ReceiverPacket* packet, uint lane) {
    return (float3)(packet->px[lane], packet->py[lane], packet->pz[lane]);
}
/// The normal of a receiver; zero where the receiver is absent.
static inline float3 receiver_normal(const global ReceiverPacket* packet, uint lane) {
    return (float3)(packet->nx[lane], packet->ny[lane], packet->nz[lane]);
}

/// The normal of the mesh below a receiver whose own a map has tilted; zero without a map.
static inline float3 receiver_mesh_normal(const global ReceiverPacket* packet, uint lane) {
    const uint packed = packet->mesh_normal[lane];
    return packed != 0 ? unpack_direction(packed) : (float3)(0.0f);
}
/// ReceiverPacket.mesh_normal of this normal: never 0.
static inline uint pack_mesh_normal(float3 normal) {
    return max(pack_direction(normal), 1u);
}

/// The row of the curve that weighs the light that arrives at a receiver.
static inline uint receiver_curve(const global ReceiverPacket* packet, uint lane) {
    return packet->surface[lane] & NEARLIGHT_RECEIVER_CURVE_MASK;
}
/// The number of surfaces between the camera and a receiver.
static inline uint receiver_surfaces(const global ReceiverPacket* packet, uint lane) {
    return packet->surface[lane] >> NEARLIGHT_RECEIVER_SURFACES_SHIFT & NEARLIGHT_RECEIVER_SURFACES_MASK;
}
/// Which of the receivers with the same sequence of random numbers it is.
static inline uint receiver_sample(const global ReceiverPacket* packet, uint lane) {
    return packet->surface[lane] >> NEARLIGHT_RECEIVER_SAMPLE_SHIFT;
}

/// Sets what a receiver of the packet gets.
static inline void store_irradiance(global IrradiancePacket* packet, uint lane, float3 irradiance) {
    packet->r[lane] = irradiance.x;
    packet->g[lane] = irradiance.y;
    packet->b[lane] = irradiance.z;
}
/// Adds to what a receiver of the packet gets.
static inline void add_irradiance_to(global IrradiancePacket* packet, uint lane, float3 more) {
    packet->r[lane] += more.x;
    packet->g[lane] += more.y;
    packet->b[lane] += more.z;
}

#endif
