// SPDX-License-Identifier: Apache-2.0
// Sums a VPL set over receivers, for CPUs: irradiance E(x) = Σ power/π · max0(cosθx)·max0(cosθy)/max(r², R²) · V.
//
// One work-item takes one packet of receivers against a run of VPLs. The compiler does not turn a divergent
// traversal loop into vector code, so the vectors are written out: a packet is GATHER_GROUPS groups of 16
// lanes that go through the wide tree together. What makes this fast:
// - All rays of a packet start at the VPL, so box − origin is the same for all lanes, and the triangle test is
//   three dot products a lane with constants of the (VPL, triangle) pair, without a division.
// - A node tests its eight children at once against the shaft from the VPL to the box of the receivers. Only
//   what meets the shaft is tested lane by lane, when its turn comes.
// - An inner node is entered as soon as one group meets its box, and remembers that group: the groups before it
//   need not be looked at again below [Overbeck et al., Large Ray Packets for Real-time Whitted Ray Tracing,
//   2008]. A leaf notes which groups meet it.
// - A block's four triangles are tested at once against the shaft before any lane is.
// - A lane that is culled or occluded has t_max = −1, which no box and no triangle passes: no other mask is kept.
//
// gather_rays.cl computes the same on GPUs. host/stages/gatherer.h is the interface of both.

#include "lib/bvh_traverse.cl"
#include "lib/gather.cl"

#ifndef GATHER_PACKET_WIDTH
#define GATHER_PACKET_WIDTH \
    NEARLIGHT_PACKET_SIZE  // receivers that go through the tree together: 16, 32 or 64
#endif
#define GATHER_GROUPS (GATHER_PACKET_WIDTH / 16)
#define GATHER_ALL_GROUPS ((1u << GATHER_GROUPS) - 1)
#ifdef __has_builtin
#if __has_builtin(__builtin_reduce_or)
#define GATHER_REDUCE_OR
#endif
#if __has_builtin(__builtin_prefetch)
#define GATHER_PREFETCH
#endif
#endif

// Entries of a traversal stack: each level leaves all children but one behind.
#define GATHER_STACK_SIZE ((NEARLIGHT_WIDE_CHILDREN - 1) * NEARLIGHT_MAX_BVH_DEPTH + NEARLIGHT_WIDE_CHILDREN)

/// Bounds keep so far outside of what they bound, relatively: several roundings.
#define GATHER_SLACK 4e-7f

/// What holds all segments of a packet: at fraction t of its way each is within t·[low, high] of the origin.
typedef struct Shaft {
    float3 center, extent;        // of [low, high], the extent with slack
    float3 reach;                 // the greater of |low| and |high|
    float by_low[3], by_high[3];  // reciprocals of low and high
    uint straddles;               // 1: low and high differ in sign along some axis
    // If not:
    uint near[3];                 // which plane of a box comes first: 0 the lower, WIDE_UPPER the upper
    float by_near[3], by_far[3];  // what near and far planes are divided by, reciprocal
} Shaft;

// Floats from a lower plane of a WideNode to the upper one.
#define WIDE_UPPER (3 * NEARLIGHT_WIDE_CHILDREN)

/// Segments from one VPL to the receivers of a packet; the points on them are origin + t·(dx, dy, dz).
typedef struct Segments {
    float16 dx[GATHER_GROUPS], dy[GATHER_GROUPS], dz[GATHER_GROUPS];
    float16 reciprocal_x[GATHER_GROUPS], reciprocal_y[GATHER_GROUPS], reciprocal_z[GATHER_GROUPS];
    float16 t_max[GATHER_GROUPS];  // −1: culled or occluded
    float16 weight[GATHER_GROUPS];
    float3 origin;
    Shaft shaft;
} Segments;

/// Box around the receivers of a packet that are there.
typedef struct PacketBounds {
    float3 low, high;
} PacketBounds;

typedef struct Accumulator {
    float16 r[GATHER_GROUPS], g[GATHER_GROUPS], b[GATHER_GROUPS];
} Accumulator;

// The spelled-out comparisons compile to one instruction each; fmin() and fmax() have to look after NaN.
inline float16 min16(float16 a, float16 b) {
    return a < b ? a : b;
}
inline float16 max16(float16 a, float16 b) {
    return a > b ? a : b;
}
inline float8 min8(float8 a, float8 b) {
    return a < b ? a : b;
}
inline float8 max8(float8 a, float8 b) {
    return a > b ? a : b;
}

/// True if any lane is −1. Some drivers compile any() to a branch a lane pair.
inline bool any_lane(int16 mask) {
#ifdef GATHER_REDUCE_OR
    return __builtin_reduce_or(mask) != 0;
#else
    const int8 a = mask.lo | mask.hi;
    const int4 b = a.lo | a.hi;
    const int2 c = b.lo | b.hi;
    return (c.x | c.y) != 0;
#endif
}

/// A number with bit i set where lane i is −1.
inline uint lane_bits(int8 mask) {
    const int8 bits = mask & (int8)(1, 2, 4, 8, 16, 32, 64, 128);
#ifdef GATHER_REDUCE_OR
    return (uint)__builtin_reduce_or(bits);
#else
    const int4 a = bits.lo | bits.hi;
    const int2 b = a.lo | a.hi;
    return (uint)(b.x | b.y);
#endif
}

inline uint lowest_bit(uint bits) {
    return 31 - clz(bits & -bits);
}

/// Asks for the memory of a node or of a leaf's first block, which take three cache lines or more.
inline void prefetch(const global WideNode* nodes, const global TriangleBlock* blocks, uint child) {
#ifdef GATHER_PREFETCH
    const bool leaf = (child & NEARLIGHT_LEAF_BIT) != 0;
    const global char* at = leaf ? (const global char*)(blocks + (child & NEARLIGHT_LEAF_FIRST_MASK))
                                 : (const global char*)(nodes + child);
    __builtin_prefetch(at);
    __builtin_prefetch(at + 64);
    __builtin_prefetch(at + 128);
#endif
}

inline float16 reciprocal16(float16 d) {
    const float16 tiny = (float16)1e-20f;
    return 1.0f / (fabs(d) < tiny ? copysign(tiny, d) : d);
}

inline bool all_done(const Segments* s) {
    int16 open = (int16)0;
    for (uint group = 0; group < GATHER_GROUPS; ++group) {
        open |= s->t_max[group] > 0.0f;
    }
    return !any_lane(open);
}

/// −1 in the lanes of children that the shaft may meet: those for which some t has t·high above the lower
/// plane and t·low below the upper one, on each axis. What this rejects, every segment misses.
inline int8 children_in_shaft(const Shaft* shaft, float3 from, const global WideNode* node) {
    const float origin[3] = {from.x, from.y, from.z};
    float8 enter = (float8)NEARLIGHT_SEGMENT_T_MIN;
    float8 leave = (float8)NEARLIGHT_SEGMENT_T_MAX;
    for (uint axis = 0; axis < 3; ++axis) {
        const global float* planes = node->low[axis];
        if (!shaft->straddles) {
            const uint near = shaft->near[axis];
            enter = max8(enter, (vload8(0, planes + near) - origin[axis]) * shaft->by_near[axis]);
            leave =
                min8(leave, (vload8(0, planes + (WIDE_UPPER - near)) - origin[axis]) * shaft->by_far[axis]);
            continue;
        }
        const float8 low = (vload8(0, planes) - origin[axis]) * shaft->by_high[axis];
        const float8 high = (vload8(0, planes + WIDE_UPPER) - origin[axis]) * shaft->by_low[axis];
        enter = shaft->by_high[axis] > 0.0f ? max8(enter, low) : enter;
        leave = shaft->by_high[axis] > 0.0f ? leave : min8(leave, low);
        enter = shaft->by_low[axis] < 0.0f ? max8(enter, high) : enter;
        leave = shaft->by_low[axis] < 0.0f ? leave : min8(leave, high);
    }
    return enter <= leave;
}

/// One bit for each group from `group` on that has a segment in the box of a child; if `only_first`, no more
/// than the first of them.
inline uint groups_in_child(const Segments* s, const global WideNode* node, uint slot, uint group,
                            bool only_first) {
    const Shaft* shaft = &s->shaft;
    const global float* x = node->low[0] + slot;
    const global float* y = node->low[1] + slot;
    const global float* z = node->low[2] + slot;
    const float near_x = x[shaft->near[0]] - s->origin.x,
                far_x = x[WIDE_UPPER - shaft->near[0]] - s->origin.x;
    const float near_y = y[shaft->near[1]] - s->origin.y,
                far_y = y[WIDE_UPPER - shaft->near[1]] - s->origin.y;
    const float near_z = z[shaft->near[2]] - s->origin.z,
                far_z = z[WIDE_UPPER - shaft->near[2]] - s->origin.z;
    const float16 t_min = (float16)NEARLIGHT_SEGMENT_T_MIN;
    uint groups = 0;
    for (; group < GATHER_GROUPS && !(only_first && groups != 0); ++group) {
        const float16 x0 = near_x * s->reciprocal_x[group], x1 = far_x * s->reciprocal_x[group];
        const float16 y0 = near_y * s->reciprocal_y[group], y1 = far_y * s->reciprocal_y[group];
        const float16 z0 = near_z * s->reciprocal_z[group], z1 = far_z * s->reciprocal_z[group];
        const float16 t_max = s->t_max[group];
        const bool meets =
            shaft->straddles
                ? any_lane(max16(max16(min16(x0, x1), min16(y0, y1)), max16(min16(z0, z1), t_min)) <=
                           min16(min16(max16(x0, x1), max16(y0, y1)), min16(max16(z0, z1), t_max)))
                : any_lane(max16(max16(x0, y0), max16(z0, t_min)) <= min16(min16(x1, y1), min16(z1, t_max)));
        groups |= meets ? 1u << group : 0u;
    }
    return groups;
}

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
    const float4 slack = GATHER_SLACK * ((fabs(u.x) + fabs(v.x) + fabs(n.x)) * s->shaft.reach.x +
                                         (fabs(u.y) + fabs(v.y) + fabs(n.y)) * s->shaft.reach.y +
                                         (fabs(u.z) + fabs(v.z) + fabs(n.z)) * s->shaft.reach.z);
    const int4 may = (greatest_in_shaft(u, &s->shaft) >= -slack) &
                     (greatest_in_shaft(v, &s->shaft) >= -slack) &
                     (greatest_in_shaft(w, &s->shaft) >= -slack) &
                     (t * (1.0f - GATHER_SLACK) < greatest_in_shaft(n, &s->shaft) + slack);
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

/// A child on the stack: its reference, and where its box stands, with the first group that met the parent.
typedef uint2 StackEntry;
inline StackEntry make_entry(const global WideNode* node, uint index, uint slot, uint group) {
    return (StackEntry)(node->child[slot], group << 29 | index << 3 | slot);
}
inline uint entry_node(StackEntry entry) {
    return (entry.y & 0x1fffffffu) >> 3;
}
inline uint entry_slot(StackEntry entry) {
    return entry.y & 7u;
}
inline uint entry_group(StackEntry entry) {
    return entry.y >> 29;
}

/// Ends the segments (t_max = −1) that meet anything.
inline void trace_segments(Segments* s, const global WideNode* nodes, const global TriangleBlock* blocks) {
    StackEntry stack[GATHER_STACK_SIZE];
    int top = 0;
    uint index = 0;
    uint group = 0;
    for (;;) {
        const global WideNode* node = nodes + index;
        for (uint met = lane_bits(children_in_shaft(&s->shaft, s->origin, node)); met != 0; met &= met - 1) {
            const uint slot = lowest_bit(met);
            stack[top++] = make_entry(node, index, slot, group);
            prefetch(nodes, blocks, node->child[slot]);
        }
        // Leaves until the next inner node that a segment meets.
        for (;;) {
            if (top == 0) {
                return;
            }
            const StackEntry entry = stack[--top];
            const bool leaf = (entry.x & NEARLIGHT_LEAF_BIT) != 0;
            const uint groups =
                groups_in_child(s, nodes + entry_node(entry), entry_slot(entry), entry_group(entry), !leaf);
            if (groups == 0) {
                continue;
            }
            if (!leaf) {
                index = entry.x;
                group = lowest_bit(groups);
                break;
            }
            if (intersect_leaf(s, blocks, entry.x, groups) && all_done(s)) {
                return;
            }
        }
    }
}

/// What holds the segments from `origin` to everything within the bounds.
inline void make_shaft(Shaft* shaft, float3 origin, const PacketBounds* bounds) {
    const float3 low = bounds->low - origin;
    const float3 high = bounds->high - origin;
    shaft->center = 0.5f * (low + high);
    shaft->reach = fmax(fabs(low), fabs(high));
    shaft->extent = 0.5f * (high - low) + GATHER_SLACK * shaft->reach;
    const float3 by_low3 = safe_reciprocal(low);
    const float3 by_high3 = safe_reciprocal(high);
    const float by_low[3] = {by_low3.x, by_low3.y, by_low3.z};
    const float by_high[3] = {by_high3.x, by_high3.y, by_high3.z};
    shaft->straddles = 0;
    for (uint axis = 0; axis < 3; ++axis) {
        const bool down = by_low[axis] < 0.0f;
        shaft->straddles |= down && by_high[axis] > 0.0f ? 1u : 0u;
        shaft->by_low[axis] = by_low[axis];
        shaft->by_high[axis] = by_high[axis];
        shaft->near[axis] = down ? WIDE_UPPER : 0;
        shaft->by_near[axis] = down ? by_low[axis] : by_high[axis];
        shaft->by_far[axis] = (down ? by_high[axis] : by_low[axis]) * (1.0f + GATHER_SLACK);
    }
}

/// Ends the segments that meet anything.
inline void test_visibility(Segments* s, const PacketBounds* bounds, const global WideNode* nodes,
                            const global TriangleBlock* blocks) {
    if (!all_done(s)) {
        make_shaft(&s->shaft, s->origin, bounds);
        trace_segments(s, nodes, blocks);
    }
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

#ifdef GATHER_RECORD
inline void record_open(const Segments* s, global uchar* record) {
    for (uint group = 0; group < GATHER_GROUPS; ++group) {
        const int16 open = s->t_max[group] > 0.0f;
        vstore16(convert_uchar16(open & (int)GATHER_RECORD_VISIBLE), group, record);
    }
}
inline void record_occluded(const Segments* s, global uchar* record) {
    for (uint group = 0; group < GATHER_GROUPS; ++group) {
        const uchar16 traced = vload16(group, record);
        const uchar16 occluded = convert_uchar16((s->t_max[group] < 0.0f) & (int)GATHER_RECORD_OCCLUDED);
        vstore16(traced != (uchar16)0 ? max(traced, occluded) : traced, group, record);
    }
}
#endif

inline void add_visible(Accumulator* sum, const Segments* s, float3 scale, bool squared) {
    for (uint group = 0; group < GATHER_GROUPS; ++group) {
        const float16 term = s->t_max[group] > 0.0f ? s->weight[group] : (float16)0.0f;
        const float16 weight = squared ? term * term : term;
        sum->r[group] += scale.x * weight;
        sum->g[group] += scale.y * weight;
        sum->b[group] += scale.z * weight;
    }
}

inline void clear(Accumulator* sum) {
    for (uint group = 0; group < GATHER_GROUPS; ++group) {
        sum->r[group] = sum->g[group] = sum->b[group] = (float16)0.0f;
    }
}

/// irradiance (+)= sum, where `replace` says not to add.
inline void add_to_irradiance(global IrradiancePacket* irradiance, uint first_lane, const Accumulator* sum,
                              bool replace) {
    for (uint group = 0; group < GATHER_GROUPS; ++group) {
        const uint at = first_lane / 16 + group;
        const float16 none = (float16)0.0f;
        vstore16(sum->r[group] + (replace ? none : vload16(at, irradiance->r)), at, irradiance->r);
        vstore16(sum->g[group] + (replace ? none : vload16(at, irradiance->g)), at, irradiance->g);
        vstore16(sum->b[group] + (replace ? none : vload16(at, irradiance->b)), at, irradiance->b);
    }
}

/// One work-item for each GATHER_PACKET_WIDTH receivers of the packets [first_packet, end_packet), over the
/// VPLs [first_vpl, end_vpl). Each GATHER_CHUNK of VPLs, counted from VPL 0, is summed by itself and then
/// added to the irradiance, so that the result does not depend on how launches divide the work; first_vpl
/// must be a multiple of GATHER_CHUNK. Launches over the VPLs of one packet must follow one another in order,
/// from 0.
kernel __attribute__((reqd_work_group_size(1, 1, 1))) void gather_packets(
    const global WideNode* nodes, const global TriangleBlock* blocks, const global Vpl* vpls, uint first_vpl,
    uint end_vpl, const global ReceiverPacket* receivers, uint first_packet, uint end_packet,
    float clamp_radius_squared, global IrradiancePacket* irradiance GATHER_ROULETTE_PARAMETERS
        GATHER_RECORD_PARAMETERS) {
    const uint item = (uint)get_global_id(0);
    const uint packet = first_packet + item / (NEARLIGHT_PACKET_SIZE / GATHER_PACKET_WIDTH);
    const uint first_lane = item % (NEARLIGHT_PACKET_SIZE / GATHER_PACKET_WIDTH) * GATHER_PACKET_WIDTH;
    if (packet >= end_packet) {
        return;
    }
    const PacketBounds bounds = bounds_of(receivers + packet, first_lane);
    Segments segments;
    Accumulator sum;
    const uint end = GATHER_END(packet, end_vpl);
    for (uint chunk = first_vpl; chunk < end || chunk == 0; chunk += GATHER_CHUNK) {
        clear(&sum);
        for (uint k = chunk; k < min(chunk + GATHER_CHUNK, end); ++k) {
            const uint i = GATHER_VPL(packet, k);
            connect(&segments, vpls + i, receivers + packet, first_lane, clamp_radius_squared);
#ifdef GATHER_RECORD
            global uchar* pairs = record + gather_record_index(packet, i, record_vpl_count, first_lane);
            record_open(&segments, pairs);
#endif
            test_visibility(&segments, &bounds, nodes, blocks);
#ifdef GATHER_RECORD
            record_occluded(&segments, pairs);
#endif
            add_visible(&sum, &segments, gather_scale(vpls + i) * GATHER_WEIGHT(packet, k),
                        gather_squared(vpls + i));
        }
        add_to_irradiance(irradiance + packet, first_lane, &sum, chunk == 0);
    }
}
