// SPDX-License-Identifier: Apache-2.0
// Blocks of four triangles against a packet of segments: all four against the shaft, then one by one against lanes.
#ifndef NEARLIGHT_LIB_PACKET_BLOCKS
#define NEARLIGHT_LIB_PACKET_BLOCKS

#include "lib/segments.cl"

/// For each triangle of a block, which are turned towards the origin so that the sign of t is the same for
/// all segments: a direction d hits if 0 ≤ u·d, 0 ≤ v·d, 0 ≤ w·d and t_min·(n·d) < t < t_max·(n·d). In exact
/// numbers w = n − u − v, but the rounding of u and v grows with the longest edge, that of w only with its own:
/// a sliver would reach far beyond its short edge.
typedef struct BlockAxes {
    float u[3][NEARLIGHT_BLOCK_TRIANGLES], v[3][NEARLIGHT_BLOCK_TRIANGLES], w[3][NEARLIGHT_BLOCK_TRIANGLES];
    float n[3][NEARLIGHT_BLOCK_TRIANGLES];
    float t[NEARLIGHT_BLOCK_TRIANGLES];
} BlockAxes;

typedef struct Axis4 {
    float4 x, y, z;
} Axis4;

inline Axis4 load_axis(const global float* rows) {
    const Axis4 axis = {vload4(0, rows), vload4(1, rows), vload4(2, rows)};
    return axis;
}
inline void store_axis(Axis4 axis, float (*rows)[NEARLIGHT_BLOCK_TRIANGLES]) {
    vstore4(axis.x, 0, rows[0]);
    vstore4(axis.y, 0, rows[1]);
    vstore4(axis.z, 0, rows[2]);
}
inline Axis4 cross4(Axis4 a, Axis4 b) {
    const Axis4 axis = {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
    return axis;
}
inline Axis4 minus4(Axis4 a, Axis4 b) {
    const Axis4 axis = {a.x - b.x, a.y - b.y, a.z - b.z};
    return axis;
}
inline Axis4 scale4(Axis4 a, float4 by) {
    const Axis4 axis = {a.x * by, a.y * by, a.z * by};
    return axis;
}
/// The greatest axis · d of all directions in the shaft.
inline float4 greatest_in_shaft(Axis4 axis, const Shaft* shaft) {
    return axis.x * shaft->center.x + axis.y * shaft->center.y + axis.z * shaft->center.z +
           (fabs(axis.x) * shaft->extent.x + fabs(axis.y) * shaft->extent.y + fabs(axis.z) * shaft->extent.z);
}

/// Prepares a block's triangles. Returns one bit for each that the shaft may hit.
inline uint prepare_block(const Segments* s, const global TriangleBlock* block, BlockAxes* axes) {
    const Axis4 edge1 = load_axis(block->edge1[0]);
    const Axis4 edge2 = load_axis(block->edge2[0]);
    const Axis4 v0 = load_axis(block->v0[0]);
    const Axis4 to_origin = {s->origin.x - v0.x, s->origin.y - v0.y, s->origin.z - v0.z};
    const Axis4 normal = cross4(edge1, edge2);
    const float4 distance = to_origin.x * normal.x + to_origin.y * normal.y + to_origin.z * normal.z;
    const float4 side = distance < 0.0f ? (float4)-1.0f : (float4)1.0f;
    const Axis4 n = scale4(normal, -side);
    const Axis4 u = scale4(cross4(edge2, to_origin), side);
    const Axis4 v = scale4(cross4(to_origin, edge1), side);
    const Axis4 w = scale4(cross4(minus4(edge1, edge2), minus4(to_origin, edge1)), side);
    const float4 t = fabs(distance);
    store_axis(u, axes->u);
    store_axis(v, axes->v);
    store_axis(w, axes->w);
    store_axis(n, axes->n);
    vstore4(t, 0, axes->t);
    const float4 slack = SHAFT_SLACK * ((fabs(u.x) + fabs(v.x) + fabs(n.x)) * s->shaft.reach.x +
                                         (fabs(u.y) + fabs(v.y) + fabs(n.y)) * s->shaft.reach.y +
                                         (fabs(u.z) + fabs(v.z) + fabs(n.z)) * s->shaft.reach.z);
    const int4 may = (greatest_in_shaft(u, &s->shaft) >= -slack) &
                     (greatest_in_shaft(v, &s->shaft) >= -slack) &
                     (greatest_in_shaft(w, &s->shaft) >= -slack) &
                     (t * (1.0f - SHAFT_SLACK) < greatest_in_shaft(n, &s->shaft) + slack);
    return lane_bits((int8)(may, (int4)0));
}

/// Ends the segments of some groups that meet triangle i of a prepared block. Returns −1 where one ended.
inline int16 intersect_triangle(Segments* s, const BlockAxes* axes, uint i, uint groups) {
    const float16 t = (float16)axes->t[i];
    int16 any_hit = (int16)0;
    for (; groups != 0; groups &= groups - 1) {
        const uint group = lowest_bit(groups);
        const float16 dx = s->dx[group], dy = s->dy[group], dz = s->dz[group];
        const float16 det = axes->n[0][i] * dx + axes->n[1][i] * dy + axes->n[2][i] * dz;
        const float16 u = axes->u[0][i] * dx + axes->u[1][i] * dy + axes->u[2][i] * dz;
        const float16 v = axes->v[0][i] * dx + axes->v[1][i] * dy + axes->v[2][i] * dz;
        const float16 w = axes->w[0][i] * dx + axes->w[1][i] * dy + axes->w[2][i] * dz;
        const int16 hit = (u >= 0.0f) & (v >= 0.0f) & (w >= 0.0f) & (t > NEARLIGHT_SEGMENT_T_MIN * det) &
                          (t < s->t_max[group] * det);
        s->t_max[group] = hit ? (float16)-1.0f : s->t_max[group];
        any_hit |= hit;
    }
    return any_hit;
}

/// Ends the segments of some groups that meet a triangle of the leaf. Returns true if any segment ended.
inline bool intersect_leaf(Segments* s, const global TriangleBlock* blocks, uint leaf, uint groups) {
    const uint first = leaf & NEARLIGHT_LEAF_FIRST_MASK;
    const uint last = first + ((leaf >> NEARLIGHT_LEAF_COUNT_SHIFT) & NEARLIGHT_LEAF_COUNT_MASK);
    int16 any_hit = (int16)0;
    for (uint block = first; block <= last; ++block) {
        BlockAxes axes;
        for (uint may = prepare_block(s, blocks + block, &axes); may != 0; may &= may - 1) {
            any_hit |= intersect_triangle(s, &axes, lowest_bit(may), groups);
        }
    }
    return any_lane(any_hit);
}

#endif
