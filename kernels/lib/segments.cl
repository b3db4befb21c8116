// SPDX-License-Identifier: Apache-2.0
// The shadow rays of a beam, which come from one VPL.
#ifndef NEARLIGHT_LIB_SEGMENTS
#define NEARLIGHT_LIB_SEGMENTS

#include "lib/curve.cl"
#include "lib/shaft.cl"

/// The segments from one VPL to the receivers of a beam. The points on them are origin + t·(dx, dy, dz).
typedef struct Segments {
    float16 dx[GATHER_ROWS], dy[GATHER_ROWS], dz[GATHER_ROWS];
    float16 reciprocal_x[GATHER_ROWS], reciprocal_y[GATHER_ROWS], reciprocal_z[GATHER_ROWS];
    float16 weight[GATHER_ROWS];  // geometry terms; undefined in rows without an open lane
    float3 origin;
    uint lanes[GATHER_ROWS];  // one bit for each lane of a row that is neither culled nor occluded
    uint open;                // one bit for each cluster that has a lane neither culled nor occluded
    Shaft shaft;
    ClusterShafts clusters;
} Segments;

/// The row that the first of some clusters belongs to. `clusters` has a bit for each and must not be 0.
LANES_INLINE uint first_row(uint clusters) {
    return lowest_bit(clusters) / ROW_CLUSTERS;
}
/// One bit for each cluster of a row.
LANES_INLINE uint clusters_of_row(uint row) {
    return ((1u << ROW_CLUSTERS) - 1) << ROW_CLUSTERS * row;
}

/// One bit for each cluster of a row that has one of the given lanes.
LANES_INLINE uint clusters_of_lanes(uint row, uint lanes) {
    uint clusters = 0;
    for (uint i = 0; i < ROW_CLUSTERS; ++i) {
        const uint of_cluster = lanes >> CLUSTER_SIZE * i & ((1u << CLUSTER_SIZE) - 1);
        clusters |= (of_cluster != 0 ? 1u : 0u) << i;
    }
    return clusters << ROW_CLUSTERS * row;
}

/// Sets which segments of a row are open: those whose bits are set in `lanes`.
LANES_INLINE void set_lanes(Segments* s, uint row, uint lanes) {
    s->lanes[row] = lanes;
    s->open = (s->open & ~clusters_of_row(row)) | clusters_of_lanes(row, lanes);
}

/// Ends the segments of a row whose bits are set in `lanes`. It is called even where no bit is set, because a
/// branch around it could not be predicted.
LANES_INLINE void end_lanes(Segments* s, uint row, uint lanes) {
    set_lanes(s, row, s->lanes[row] & ~lanes);
}

/// Sets up the segments to the receivers that face the VPL and are faced by it, with their geometry terms.
static inline void connect(Segments* s, const global Vpl* vpl, const Receivers* receivers,
                           float clamp_radius_squared) {
    s->origin = load3(vpl->position);
    s->open = 0;
    const float3 vpl_normal = load3(vpl->normal);
    for (uint row = 0; row < GATHER_ROWS; ++row) {
        const float16 dx = receivers->x[row] - s->origin.x;
        const float16 dy = receivers->y[row] - s->origin.y;
        const float16 dz = receivers->z[row] - s->origin.z;
        const float16 cos_vpl = vpl_normal.x * dx + vpl_normal.y * dy + vpl_normal.z * dz;
        const float16 cos_receiver =
            -(receivers->nx[row] * dx + receivers->ny[row] * dy + receivers->nz[row] * dz);
        // In a room, half of the rows face away from a VPL and need no division.
        const int16 facing = (cos_vpl > 0.0f) & (cos_receiver > 0.0f);
        if (lane_bits16(facing) == 0) {
            s->lanes[row] = 0;
            continue;
        }
        const float16 r2 = dx * dx + dy * dy + dz * dz;
        // Each of the cosines still carries a factor r.
        const float16 weight = cos_vpl * cos_receiver / (r2 * max16(r2, (float16)clamp_radius_squared));
        const int16 open = facing & (weight < INFINITY);
        s->dx[row] = dx;
        s->dy[row] = dy;
        s->dz[row] = dz;
        s->reciprocal_x[row] = reciprocal16(dx);
        s->reciprocal_y[row] = reciprocal16(dy);
        s->reciprocal_z[row] = reciprocal16(dz);
        s->weight[row] = weight;
        set_lanes(s, row, lane_bits16(open));
    }
}

/// Ends the segments that leave the VPL behind the normal by which it is seen.
static inline void leave_out_unseen(Segments* s, float3 seen_normal) {
    for (uint open = s->open; open != 0; open &= ~clusters_of_row(first_row(open))) {
        const uint row = first_row(open);
        const float16 height =
            seen_normal.x * s->dx[row] + seen_normal.y * s->dy[row] + seen_normal.z * s->dz[row];
        end_lanes(s, row, lane_bits16(height <= 0.0f));
    }
}

/// Ends the segments whose light, squared, is less than the receiver's threshold.
static inline void leave_out_small(Segments* s, const Receivers* receivers, float square_scale) {
    for (uint open = s->open; open != 0; open &= ~clusters_of_row(first_row(open))) {
        const uint row = first_row(open);
        const float16 square = s->weight[row] * s->weight[row] * square_scale;
        end_lanes(s, row, lane_bits16(square < receivers->threshold[row]));
    }
}

/// Multiplies the geometry terms of open segments by the transmission curves of both ends.
static inline void weigh_by_curves(Segments* s, const global Vpl* vpl, const Receivers* receivers,
                                   const global float* curves) {
    const float3 vpl_normal = seen_normal(vpl);
    const uint row_of_vpl = vpl_curve(vpl);
    for (uint open = s->open; open != 0; open &= ~clusters_of_row(first_row(open))) {
        const uint row = first_row(open);
        if (row_of_vpl == 0 && (receivers->curved_rows >> row & 1) == 0) {
            continue;
        }
        const float16 dx = s->dx[row], dy = s->dy[row], dz = s->dz[row];
        const float16 inverse = rsqrt(dx * dx + dy * dy + dz * dz);
        float cos_vpl[16], cos_receiver[16];
        vstore16((vpl_normal.x * dx + vpl_normal.y * dy + vpl_normal.z * dz) * inverse, 0, cos_vpl);
        vstore16(-(receivers->nx[row] * dx + receivers->ny[row] * dy + receivers->nz[row] * dz) * inverse, 0,
                 cos_receiver);
        float* weight = (float*)(s->weight + row);
        for (uint lanes = s->lanes[row]; lanes != 0; lanes &= lanes - 1) {
            const uint lane = lowest_bit(lanes);
            weight[lane] *= curve_value(curves, row_of_vpl, cos_vpl[lane]) *
                            curve_value(curves, receivers->curve[16 * row + lane], cos_receiver[lane]);
        }
    }
}

/// Multiplies the geometry terms of open segments by what the receivers' maps leave of the light
/// (lib/map_shadowing.cl).
static inline void weigh_by_maps(Segments* s, const Receivers* receivers) {
    for (uint open = s->open; open != 0; open &= ~clusters_of_row(first_row(open))) {
        const uint row = first_row(open);
        if ((receivers->mapped_rows >> row & 1) == 0) {
            continue;
        }
        const float16 dx = s->dx[row], dy = s->dy[row], dz = s->dz[row];
        const float16 r2 = dx * dx + dy * dy + dz * dz;
        const float16 cosine =
            -(receivers->mesh_x[row] * dx + receivers->mesh_y[row] * dy + receivers->mesh_z[row] * dz);
        const float16 cos2 = fmax(cosine * cosine / r2, (float16)1e-12f);
        const float16 tan2 = fmax(1.0f - cos2, (float16)0.0f) / cos2;
        const float16 part = 2.0f / (1.0f + sqrt(1.0f + receivers->map_tilt[row] * tan2));
        s->weight[row] *= cosine > 0.0f ? part : (float16)0.0f;
    }
}

/// One bit for each open lane of a row whose segment meets the box. A segment that meets a box also meets
/// every box that contains it, even in rounded arithmetic, because rounding keeps the order of numbers.
LANES_INLINE uint lanes_in_box(const Segments* s, uint row, const Planes* p) {
    const float16 x0 = p->x0 * s->reciprocal_x[row], x1 = p->x1 * s->reciprocal_x[row];
    const float16 y0 = p->y0 * s->reciprocal_y[row], y1 = p->y1 * s->reciprocal_y[row];
    const float16 z0 = p->z0 * s->reciprocal_z[row], z1 = p->z1 * s->reciprocal_z[row];
    const float16 t_min = (float16)NEARLIGHT_SEGMENT_T_MIN, t_max = (float16)NEARLIGHT_SEGMENT_T_MAX;
    if (!s->shaft.straddles) {
        const float16 enter = max16(max16(x0, y0), max16(z0, t_min));
        return s->lanes[row] & lane_bits16(enter <= min16(min16(x1, y1), min16(z1, t_max)));
    }
    const float16 enter = max16(max16(min16(x0, x1), min16(y0, y1)), max16(min16(z0, z1), t_min));
    const float16 leave = min16(min16(max16(x0, x1), max16(y0, y1)), min16(max16(z0, z1), t_max));
    return s->lanes[row] & lane_bits16(enter <= leave);
}

#endif
