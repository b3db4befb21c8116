// SPDX-License-Identifier: Apache-2.0
// Tests blocks of four triangles against the segments that meet the box of their leaf. A row with many such
// lanes is tested triangle by triangle, with the triangles that the shaft may hit. A row with few of them is
// tested lane by lane, with all four triangles in one vector. Testing four lanes in one vector is no faster,
// because half of these rows have a single lane.
#ifndef NEARLIGHT_LIB_BEAM_BLOCKS
#define NEARLIGHT_LIB_BEAM_BLOCKS

#include "lib/segments.cl"

/// The axes of each triangle of a block, turned towards the origin so that the sign of t is the same for all
/// segments: a direction d hits if 0 ≤ u·d, 0 ≤ v·d, 0 ≤ w·d and t_min·(n·d) < t < t_max·(n·d). In exact
/// arithmetic w = n − u − v. But the rounding error of u and v grows with the longest edge, and that of w
/// only with its own edge: computed as n − u − v, w would let a sliver reach far beyond its short edge.
typedef struct BlockAxes {
    Axis4 u, v, w, n;
    float4 t;
} BlockAxes;

/// A leaf, a row of lanes, and one bit for each lane of the row that meets the box of the leaf.
typedef struct LeafVisit {
    uint leaf, row, lanes;
} LeafVisit;

// The maximum number of lanes of a row that are tested one after the other.
#define FEW_LANES 8

LANES_INLINE Axis4 minus4(Axis4 a, Axis4 b) {
    const Axis4 axis = {a.x - b.x, a.y - b.y, a.z - b.z};
    return axis;
}
LANES_INLINE Axis4 scale4(Axis4 a, float4 by) {
    const Axis4 axis = {a.x * by, a.y * by, a.z * by};
    return axis;
}
/// The maximum of axis · d over all directions d in the shaft.
LANES_INLINE float4 max_in_shaft(Axis4 axis, const Shaft* shaft) {
    return axis.x * shaft->center.x + axis.y * shaft->center.y + axis.z * shaft->center.z +
           (fabs(axis.x) * shaft->extent.x + fabs(axis.y) * shaft->extent.y + fabs(axis.z) * shaft->extent.z);
}

/// Computes the axes of a block's triangles for segments from `origin`.
LANES_INLINE void prepare_block(BlockAxes* axes, float3 origin, const global TriangleBlock* block) {
    const Axis4 edge1 = load_axis(block->edge1[0]);
    const Axis4 edge2 = load_axis(block->edge2[0]);
    const Axis4 v0 = load_axis(block->v0[0]);
    const Axis4 to_origin = {origin.x - v0.x, origin.y - v0.y, origin.z - v0.z};
    const Axis4 normal = cross4(edge1, edge2);
    const float4 distance = to_origin.x * normal.x + to_origin.y * normal.y + to_origin.z * normal.z;
    const float4 side = distance < 0.0f ? (float4)-1.0f : (float4)1.0f;
    axes->n = scale4(normal, -side);
    axes->u = scale4(cross4(edge2, to_origin), side);
    axes->v = scale4(cross4(to_origin, edge1), side);
    axes->w = scale4(cross4(minus4(edge1, edge2), minus4(to_origin, edge1)), side);
    axes->t = fabs(distance);
}

/// One bit for each triangle that the shaft may hit.
LANES_INLINE uint triangles_in_shaft(const Shaft* shaft, const BlockAxes* axes) {
    const Axis4 u = axes->u, v = axes->v, w = axes->w, n = axes->n;
    const float4 slack = SHAFT_SLACK * ((fabs(u.x) + fabs(v.x) + fabs(n.x)) * shaft->reach.x +
                                        (fabs(u.y) + fabs(v.y) + fabs(n.y)) * shaft->reach.y +
                                        (fabs(u.z) + fabs(v.z) + fabs(n.z)) * shaft->reach.z);
    const int4 may = (max_in_shaft(u, shaft) >= -slack) & (max_in_shaft(v, shaft) >= -slack) &
                     (max_in_shaft(w, shaft) >= -slack) &
                     (axes->t * (1.0f - SHAFT_SLACK) < max_in_shaft(n, shaft) + slack);
    return lane_bits4(may);
}

// The operations are fused, so that a lane gets the same bits whichever way it is tested. Where fma() would
// be a call, the compiler may choose.
#if defined(FP_FAST_FMAF) || defined(__FMA__)
#define FUSED(a, b, c) fma(a, b, c)
#else
#define FUSED(a, b, c) ((a) * (b) + (c))
#endif
LANES_INLINE float16 dot16(float16 x, float16 y, float16 z, float16 dx, float16 dy, float16 dz) {
    return FUSED(z, dz, FUSED(x, dx, y * dy));
}

/// −1 in each lane whose segment hits a triangle. `det`, `u`, `v` and `w` are the products of its direction
/// with the axes n, u, v and w.
LANES_INLINE int16 hits(float16 det, float16 u, float16 v, float16 w, float16 t) {
    return (min16(min16(u, v), w) >= 0.0f) & (t > NEARLIGHT_SEGMENT_T_MIN * det) &
           (t < NEARLIGHT_SEGMENT_T_MAX * det);
}

/// Ends the segments of a visit that hit one of the triangles of a block whose bits are set in `triangles`.
LANES_INLINE void intersect_triangles(Segments* s, const BlockAxes* axes, uint triangles,
                                      const LeafVisit* visit) {
    const float16 dx = s->dx[visit->row], dy = s->dy[visit->row], dz = s->dz[visit->row];
    int16 hit = (int16)0;
    for (; triangles != 0; triangles &= triangles - 1) {
        const uint i = lowest_bit(triangles);
        const float* u = (const float*)&axes->u + i;
        const float* v = (const float*)&axes->v + i;
        const float* w = (const float*)&axes->w + i;
        const float* n = (const float*)&axes->n + i;
        const float* t = (const float*)&axes->t + i;
        const float16 det = dot16((float16)n[0], (float16)n[4], (float16)n[8], dx, dy, dz);
        hit |= hits(det, dot16((float16)u[0], (float16)u[4], (float16)u[8], dx, dy, dz),
                    dot16((float16)v[0], (float16)v[4], (float16)v[8], dx, dy, dz),
                    dot16((float16)w[0], (float16)w[4], (float16)w[8], dx, dy, dz), (float16)*t);
    }
    end_lanes(s, visit->row, lane_bits16(hit) & visit->lanes);
}

LANES_INLINE float4 dot4(Axis4 axis, float dx, float dy, float dz) {
    return FUSED(axis.z, (float4)dz, FUSED(axis.x, (float4)dx, axis.y * dy));
}
LANES_INLINE float4 min4(float4 a, float4 b) {
    return a < b ? a : b;
}

/// Ends the segments that hit any triangle of a block, for a visit with few lanes.
LANES_INLINE void intersect_few(Segments* s, const BlockAxes* axes, const LeafVisit* visit) {
    uint hit_lanes = 0;
    for (uint lanes = visit->lanes; lanes != 0; lanes &= lanes - 1) {
        const uint lane = lowest_bit(lanes);
        const float dx = ((const float*)(s->dx + visit->row))[lane];
        const float dy = ((const float*)(s->dy + visit->row))[lane];
        const float dz = ((const float*)(s->dz + visit->row))[lane];
        const float4 det = dot4(axes->n, dx, dy, dz);
        const float4 smallest =
            min4(min4(dot4(axes->u, dx, dy, dz), dot4(axes->v, dx, dy, dz)), dot4(axes->w, dx, dy, dz));
        const int4 hit = (smallest >= 0.0f) & (axes->t > NEARLIGHT_SEGMENT_T_MIN * det) &
                         (axes->t < NEARLIGHT_SEGMENT_T_MAX * det);
        hit_lanes |= (lane_bits4(hit) != 0 ? 1u : 0u) << lane;
    }
    end_lanes(s, visit->row, hit_lanes);
}

/// Ends the segments that hit a triangle of a leaf. All of the `count` visits are to that leaf.
LANES_INLINE void intersect_leaf(Segments* s, const global TriangleBlock* blocks, const LeafVisit* visits,
                                 uint count) {
    LeafVisit dense[GATHER_ROWS + 1];
    const uint last = last_block(visits->leaf);
    for (uint block = first_block(visits->leaf); block <= last; ++block) {
        BlockAxes axes;
        prepare_block(&axes, s->origin, blocks + block);
        uint dense_count = 0;
        for (uint i = 0; i < count; ++i) {
            LeafVisit visit = visits[i];
            visit.lanes &= s->lanes[visit.row];
            if (popcount(visit.lanes) > FEW_LANES) {
                dense[dense_count++] = visit;
            } else {
                intersect_few(s, &axes, &visit);
            }
        }
        if (dense_count == 0) {
            continue;
        }
        const uint may = triangles_in_shaft(&s->shaft, &axes);
        for (uint i = 0; i < dense_count; ++i) {
            intersect_triangles(s, &axes, may, dense + i);
        }
    }
}

#endif
