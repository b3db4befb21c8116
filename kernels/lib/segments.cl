// SPDX-License-Identifier: Apache-2.0
// A packet of shadow rays from one VPL.
#ifndef NEARLIGHT_LIB_SEGMENTS
#define NEARLIGHT_LIB_SEGMENTS

#include "lib/shaft.cl"

/// Segments from one VPL to receivers; the points on them are origin + t·(dx, dy, dz).
typedef struct Segments {
    float16 dx[GATHER_GROUPS], dy[GATHER_GROUPS], dz[GATHER_GROUPS];
    float16 reciprocal_x[GATHER_GROUPS], reciprocal_y[GATHER_GROUPS], reciprocal_z[GATHER_GROUPS];
    float16 weight[GATHER_GROUPS];  // what has no open lane is not set
    float3 origin;
    uint lanes[GATHER_GROUPS];  // of each group those neither culled nor occluded, a bit each
    uint open;                  // one bit for each cluster that has a lane neither culled nor occluded
    Shaft shaft;
    ClusterShafts clusters;
} Segments;

/// The group that the first of some clusters belongs to, and all clusters of a group.
LANES_INLINE uint first_group(uint clusters) {
    return lowest_bit(clusters) / GROUP_CLUSTERS;
}
LANES_INLINE uint clusters_of_group(uint group) {
    return ((1u << GROUP_CLUSTERS) - 1) << GROUP_CLUSTERS * group;
}

/// The clusters that some lanes of a group belong to.
LANES_INLINE uint clusters_of_lanes(uint group, uint lanes) {
    uint clusters = 0;
    for (uint i = 0; i < GROUP_CLUSTERS; ++i) {
        const uint of_cluster = lanes >> CLUSTER_SIZE * i & ((1u << CLUSTER_SIZE) - 1);
        clusters |= (of_cluster != 0 ? 1u : 0u) << i;
    }
    return clusters << GROUP_CLUSTERS * group;
}

/// Sets which of a group's segments are left.
LANES_INLINE void set_lanes(Segments* s, uint group, uint lanes) {
    s->lanes[group] = lanes;
    s->open = (s->open & ~clusters_of_group(group)) | clusters_of_lanes(group, lanes);
}

/// Ends some of a group's segments. Cheap enough to be called for none, which no branch could predict.
LANES_INLINE void end_lanes(Segments* s, uint group, uint lanes) {
    set_lanes(s, group, s->lanes[group] & ~lanes);
}

/// Sets up the segments to the receivers that face the VPL and are faced by it, with their geometry term.
inline void connect(Segments* s, const global Vpl* vpl, const Receivers* receivers,
                    float clamp_radius_squared) {
    s->origin = load3(vpl->position);
    s->open = 0;
    const float3 vpl_normal = load3(vpl->normal);
    for (uint group = 0; group < GATHER_GROUPS; ++group) {
        const float16 dx = receivers->x[group] - s->origin.x;
        const float16 dy = receivers->y[group] - s->origin.y;
        const float16 dz = receivers->z[group] - s->origin.z;
        const float16 cos_vpl = vpl_normal.x * dx + vpl_normal.y * dy + vpl_normal.z * dz;
        const float16 cos_receiver =
            -(receivers->nx[group] * dx + receivers->ny[group] * dy + receivers->nz[group] * dz);
        // Half of the groups in a room face away: they need no division.
        const int16 facing = (cos_vpl > 0.0f) & (cos_receiver > 0.0f);
        if (lane_bits16(facing) == 0) {
            s->lanes[group] = 0;
            continue;
        }
        const float16 r2 = dx * dx + dy * dy + dz * dz;
        // Both cosines still carry a factor r.
        const float16 weight = cos_vpl * cos_receiver / (r2 * max16(r2, (float16)clamp_radius_squared));
        const int16 open = facing & (weight < INFINITY);
        s->dx[group] = dx;
        s->dy[group] = dy;
        s->dz[group] = dz;
        s->reciprocal_x[group] = reciprocal16(dx);
        s->reciprocal_y[group] = reciprocal16(dy);
        s->reciprocal_z[group] = reciprocal16(dz);
        s->weight[group] = weight;
        set_lanes(s, group, lane_bits16(open));
    }
}

/// Ends the segments whose light, squared, is less than the receiver's threshold.
inline void leave_out_small(Segments* s, const Receivers* receivers, float square_scale) {
    for (uint open = s->open; open != 0; open &= ~clusters_of_group(first_group(open))) {
        const uint group = first_group(open);
        const float16 square = s->weight[group] * s->weight[group] * square_scale;
        end_lanes(s, group, lane_bits16(square < receivers->threshold[group]));
    }
}

/// One bit for each lane of a group whose segment meets the box. Whoever meets a box meets all that hold it,
/// bit by bit: rounding keeps the order of numbers.
LANES_INLINE uint lanes_in_box(const Segments* s, uint group, const Planes* p) {
    const float16 x0 = p->x0 * s->reciprocal_x[group], x1 = p->x1 * s->reciprocal_x[group];
    const float16 y0 = p->y0 * s->reciprocal_y[group], y1 = p->y1 * s->reciprocal_y[group];
    const float16 z0 = p->z0 * s->reciprocal_z[group], z1 = p->z1 * s->reciprocal_z[group];
    const float16 t_min = (float16)NEARLIGHT_SEGMENT_T_MIN, t_max = (float16)NEARLIGHT_SEGMENT_T_MAX;
    if (!s->shaft.straddles) {
        const float16 enter = max16(max16(x0, y0), max16(z0, t_min));
        return s->lanes[group] & lane_bits16(enter <= min16(min16(x1, y1), min16(z1, t_max)));
    }
    const float16 enter = max16(max16(min16(x0, x1), min16(y0, y1)), max16(min16(z0, z1), t_min));
    const float16 leave = min16(min16(max16(x0, x1), max16(y0, y1)), min16(max16(z0, z1), t_max));
    return s->lanes[group] & lane_bits16(enter <= leave);
}

#endif
