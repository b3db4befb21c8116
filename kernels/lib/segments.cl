// SPDX-License-Identifier: Apache-2.0
// A packet of shadow rays from one VPL: groups of 16 lanes that go through the tree together.
#ifndef NEARLIGHT_LIB_SEGMENTS
#define NEARLIGHT_LIB_SEGMENTS

#include "lib/shaft.cl"

#ifndef GATHER_PACKET_WIDTH
#define GATHER_PACKET_WIDTH \
    NEARLIGHT_PACKET_SIZE  // receivers that go through the tree together: 16, 32 or 64
#endif
#define GATHER_GROUPS (GATHER_PACKET_WIDTH / 16)

/// Segments from one VPL to the receivers of a packet; the points on them are origin + t·(dx, dy, dz).
typedef struct Segments {
    float16 dx[GATHER_GROUPS], dy[GATHER_GROUPS], dz[GATHER_GROUPS];
    float16 reciprocal_x[GATHER_GROUPS], reciprocal_y[GATHER_GROUPS], reciprocal_z[GATHER_GROUPS];
    float16 t_max[GATHER_GROUPS];  // −1: culled or occluded
    float16 weight[GATHER_GROUPS];
    float3 origin;
    Shaft shaft;
} Segments;

inline bool all_done(const Segments* s) {
    int16 open = (int16)0;
    for (uint group = 0; group < GATHER_GROUPS; ++group) {
        open |= s->t_max[group] > 0.0f;
    }
    return !any_lane(open);
}

/// Sets up the segments to the receivers that face the VPL and are faced by it, with their geometry term.
inline void connect(Segments* s, const global Vpl* vpl, const global ReceiverPacket* packet, uint first_lane,
                    float clamp_radius_squared) {
    s->origin = load3(vpl->position);
    const float3 vpl_normal = load3(vpl->normal);
    for (uint group = 0; group < GATHER_GROUPS; ++group) {
        const uint at = first_lane / 16 + group;
        const float16 dx = vload16(at, packet->px) - s->origin.x;
        const float16 dy = vload16(at, packet->py) - s->origin.y;
        const float16 dz = vload16(at, packet->pz) - s->origin.z;
        const float16 cos_vpl = vpl_normal.x * dx + vpl_normal.y * dy + vpl_normal.z * dz;
        const float16 cos_receiver =
            -(vload16(at, packet->nx) * dx + vload16(at, packet->ny) * dy + vload16(at, packet->nz) * dz);
        const float16 r2 = dx * dx + dy * dy + dz * dz;
        // Both cosines still carry a factor r.
        const float16 weight = cos_vpl * cos_receiver / (r2 * max16(r2, (float16)clamp_radius_squared));
        const int16 open = (cos_vpl > 0.0f) & (cos_receiver > 0.0f) & (weight < INFINITY);
        s->dx[group] = dx;
        s->dy[group] = dy;
        s->dz[group] = dz;
        s->reciprocal_x[group] = reciprocal16(dx);
        s->reciprocal_y[group] = reciprocal16(dy);
        s->reciprocal_z[group] = reciprocal16(dz);
        s->weight[group] = weight;
        s->t_max[group] = open ? (float16)NEARLIGHT_SEGMENT_T_MAX : (float16)-1.0f;
    }
}

inline PacketBounds bounds_of(const global ReceiverPacket* packet, uint first_lane) {
    PacketBounds bounds = {(float3)INFINITY, (float3)-INFINITY};
    for (uint i = first_lane; i < first_lane + GATHER_PACKET_WIDTH; ++i) {
        const float3 position = (float3)(packet->px[i], packet->py[i], packet->pz[i]);
        const bool present = packet->nx[i] != 0.0f || packet->ny[i] != 0.0f || packet->nz[i] != 0.0f;
        // What is not finite is culled, and must not widen the shaft of the others.
        if (present && isfinite(position.x + position.y + position.z)) {
            bounds.low = fmin(bounds.low, position);
            bounds.high = fmax(bounds.high, position);
        }
    }
    return bounds;
}

#endif
