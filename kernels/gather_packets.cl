// SPDX-License-Identifier: Apache-2.0
// Sums a VPL set over receivers, for CPUs: irradiance E(x) = Σ power/π · max0(cosθx)·max0(cosθy)/max(r², R²)
// · V.
//
// One work-item takes one packet of receivers against a run of VPLs. The compiler does not turn a divergent
// traversal loop into vector code, so the vectors are written out: a packet is GATHER_GROUPS groups of 16
// lanes that go through the tree together. What makes this fast:
// - All rays of a packet start at the VPL, so box − origin is the same for all lanes, and the triangle test
// is
//   three dot products a lane with constants of the (VPL, triangle) pair, without a division.
// - A child is entered as soon as one group meets it, and remembers that group: the groups before it need not
// be
//   looked at again below [Overbeck et al., Large Ray Packets for Real-time Whitted Ray Tracing, 2008].
// - A lane that is culled or occluded has t_max = −1, which no box and no triangle passes: no other mask is
// kept. gather_rays.cl computes the same on GPUs. host/stages/gatherer.h is the interface of both.

#include "lib/bvh_traverse.cl"
#include "lib/gather.cl"

#ifndef GATHER_PACKET_WIDTH
#define GATHER_PACKET_WIDTH \
    NEARLIGHT_PACKET_SIZE  // receivers that go through the tree together: 16, 32 or 64
#endif
#define GATHER_GROUPS (GATHER_PACKET_WIDTH / 16)
#ifdef __has_builtin
#if __has_builtin(__builtin_reduce_or)
#define GATHER_REDUCE_OR
#endif
#if __has_builtin(__builtin_prefetch)
#define GATHER_PREFETCH
#endif
#endif

// A box of a BvhNode as floats: lower corner, a child reference, upper corner.
#define BOX_STRIDE 4

/// Segments from one VPL to the receivers of a packet; the points on them are origin + t·(dx, dy, dz).
typedef struct Segments {
    float16 dx[GATHER_GROUPS], dy[GATHER_GROUPS], dz[GATHER_GROUPS];
    float16 reciprocal_x[GATHER_GROUPS], reciprocal_y[GATHER_GROUPS], reciprocal_z[GATHER_GROUPS];
    float16 t_max[GATHER_GROUPS];  // −1: culled or occluded
    float16 weight[GATHER_GROUPS];
    float3 origin;
    // If all segments go the same way along each axis:
    uint near_x, near_y, near_z;  // which plane comes first: 0 the lower, BOX_STRIDE the upper
    // and in the rows of a BvhNode (near and far planes of the left, then of the right child; x, y, z,
    // unused):
    int16 upper_first;  // −1 where the upper plane comes first
    float16 origin_rows;
    float16 reciprocal_low, reciprocal_high;  // bounds over the packet, negated in the far rows
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

/// Asks for a child's memory before it is known whether the child will be entered.
inline void prefetch_child(const global BvhNode* nodes, const global BvhTriangle* triangles, uint child) {
#ifdef GATHER_PREFETCH
    const bool leaf = (child & NEARLIGHT_LEAF_BIT) != 0;
    __builtin_prefetch(leaf ? (const global void*)(triangles + (child & NEARLIGHT_LEAF_FIRST_MASK))
                            : (const global void*)(nodes + child));
#endif
}

inline float16 reciprocal16(float16 d) {
    const float16 tiny = (float16)1e-20f;
    return 1.0f / (fabs(d) < tiny ? copysign(tiny, d) : d);
}

/// The first group from `group` on that meets the box; GATHER_GROUPS: none. With `one_octant` all open
/// segments meet the planes in the order that near_x, near_y and near_z say.
inline uint first_group_in_box(const Segments* s, const global float* box, bool one_octant, uint group) {
    // Subtracted as vectors, because a load that repeats a number costs nothing and a shuffle does.
    const float16 near_x = (float16)box[s->near_x] - s->origin.x;
    const float16 near_y = (float16)box[s->near_y + 1] - s->origin.y;
    const float16 near_z = (float16)box[s->near_z + 2] - s->origin.z;
    const float16 far_x = (float16)box[BOX_STRIDE - s->near_x] - s->origin.x;
    const float16 far_y = (float16)box[BOX_STRIDE - s->near_y + 1] - s->origin.y;
    const float16 far_z = (float16)box[BOX_STRIDE - s->near_z + 2] - s->origin.z;
    const float16 t_min = (float16)NEARLIGHT_SEGMENT_T_MIN;
    for (; group < GATHER_GROUPS; ++group) {
        const float16 x0 = near_x * s->reciprocal_x[group], x1 = far_x * s->reciprocal_x[group];
        const float16 y0 = near_y * s->reciprocal_y[group], y1 = far_y * s->reciprocal_y[group];
        const float16 z0 = near_z * s->reciprocal_z[group], z1 = far_z * s->reciprocal_z[group];
        const float16 t_max = s->t_max[group];
        const float16 enter = one_octant
                                  ? max16(max16(x0, y0), max16(z0, t_min))
                                  : max16(max16(min16(x0, x1), min16(y0, y1)), max16(min16(z0, z1), t_min));
        const float16 leave = one_octant
                                  ? min16(min16(x1, y1), min16(z1, t_max))
                                  : min16(min16(max16(x0, x1), max16(y0, y1)), min16(max16(z0, z1), t_max));
        if (any_lane(enter <= leave)) {
            break;
        }
    }
    return group;
}

/// Ends the segments that meet the triangle. Turning the triangle towards the origin makes the sign of t the
/// same for all lanes; then 0 ≤ u, 0 ≤ v, u + v ≤ det (all scaled by det) and t_min·det < t < t_max·det.
/// Returns true if any segment ended.
inline bool intersect_triangle(Segments* s, const global BvhTriangle* triangle, uint group) {
    const float3 to_origin = s->origin - load3(triangle->v0);
    const float3 normal = load3(triangle->normal);
    const float distance = dot(to_origin, normal);
    const float side = distance < 0.0f ? -1.0f : 1.0f;
    const float3 n = normal * -side;
    const float3 u_axis = cross(load3(triangle->edge2), to_origin) * side;
    const float3 v_axis = cross(to_origin, load3(triangle->edge1)) * side;
    const float16 t = (float16)(distance * side);
    int16 any_hit = (int16)0;
    for (; group < GATHER_GROUPS; ++group) {
        const float16 dx = s->dx[group], dy = s->dy[group], dz = s->dz[group];
        const float16 det = n.x * dx + n.y * dy + n.z * dz;
        const float16 u = u_axis.x * dx + u_axis.y * dy + u_axis.z * dz;
        const float16 v = v_axis.x * dx + v_axis.y * dy + v_axis.z * dz;
        const int16 hit = (u >= 0.0f) & (v >= 0.0f) & (u + v <= det) & (t > NEARLIGHT_SEGMENT_T_MIN * det) &
                          (t < s->t_max[group] * det);
        s->t_max[group] = hit ? (float16)-1.0f : s->t_max[group];
        any_hit |= hit;
    }
    return any_lane(any_hit);
}

inline uint first_open_group(const Segments* s, uint group) {
    while (group < GATHER_GROUPS && !any_lane(s->t_max[group] > 0.0f)) {
        ++group;
    }
    return group;
}

/// Ends the segments from `group` on that meet a triangle of the leaf. Returns true if any segment ended.
inline bool intersect_leaf(Segments* s, const global BvhTriangle* triangles, uint leaf, uint group) {
    const uint first = leaf & NEARLIGHT_LEAF_FIRST_MASK;
    const uint last = first + ((leaf >> NEARLIGHT_LEAF_COUNT_SHIFT) & NEARLIGHT_LEAF_COUNT_MASK);
    bool any_hit = false;
    for (uint i = first; i <= last; ++i) {
        any_hit |= intersect_triangle(s, triangles + i, group);
    }
    return any_hit;
}

/// Whether any segment may meet the left (x) and the right (y) child. Products round upwards with their
/// factors, so what this rejects, every lane would.
inline int2 may_meet_children(const Segments* s, const global BvhNode* node) {
    const float16 stored = vload16(0, (const global float*)node);
    const float16 planes = (s->upper_first ? stored.s45670123cdef89ab : stored) - s->origin_rows;
    // Near rows: least t at which a segment enters by this plane. Far rows: minus the greatest t at which one
    // leaves.
    const float16 t = min16(planes * s->reciprocal_low, planes * s->reciprocal_high);
    const float4 near_end = (float4)(0.0f, 0.0f, 0.0f, NEARLIGHT_SEGMENT_T_MIN);
    const float4 far_end = (float4)(0.0f, 0.0f, 0.0f, -NEARLIGHT_SEGMENT_T_MAX);
    const int4 last = (int4)(0, 0, 0, -1);
    const float16 rows =
        (int16)(last, last, last, last) ? (float16)(near_end, far_end, near_end, far_end) : t;
    // The last plane entered, and minus the first plane left, in all four places of a row.
    const float16 pairs = max16(rows, rows.s1032547698badcfe);
    const float16 quads = max16(pairs, pairs.s23016745ab89efcd);
    const float16 enter_minus_leave = quads + quads.s45670123cdef89ab;
    return (int2)(enter_minus_leave.s0 <= 0.0f, enter_minus_leave.s8 <= 0.0f);
}

/// Ends the segments (t_max = −1) that meet anything.
inline void trace_segments(Segments* s, const global BvhNode* nodes, const global BvhTriangle* triangles,
                           bool one_octant) {
    uint2 stack[NEARLIGHT_MAX_BVH_DEPTH + 4];  // child, first group
    int top = 0;
    uint child = 0;
    uint group = first_open_group(s, 0);
    for (;;) {
        if (child & NEARLIGHT_LEAF_BIT) {
            if (intersect_leaf(s, triangles, child, group) && first_open_group(s, 0) == GATHER_GROUPS) {
                return;
            }
        } else {
            const global BvhNode* node = nodes + child;
            prefetch_child(nodes, triangles, node->left);
            prefetch_child(nodes, triangles, node->right);
            const int2 may_meet = one_octant ? may_meet_children(s, node) : (int2)1;
            const uint left =
                may_meet.x ? first_group_in_box(s, &node->left_min.x, one_octant, group) : GATHER_GROUPS;
            const uint right =
                may_meet.y ? first_group_in_box(s, &node->right_min.x, one_octant, group) : GATHER_GROUPS;
            if (left < GATHER_GROUPS && right < GATHER_GROUPS) {
                // For any hit the nearer child is no better than the other, and choosing costs more than it
                // gains.
                stack[top++] = (uint2)(node->right, right);
                child = node->left;
                group = left;
                continue;
            }
            if (left < GATHER_GROUPS || right < GATHER_GROUPS) {
                child = left < GATHER_GROUPS ? node->left : node->right;
                group = min(left, right);
                continue;
            }
        }
        if (top == 0) {
            return;
        }
        --top;
        child = stack[top].x;
        group = stack[top].y;
    }
}

inline float16 rows_of(float3 near_row, float3 far_row) {
    return (float16)(near_row, 0.0f, far_row, 0.0f, near_row, 0.0f, far_row, 0.0f);
}

/// Prepares may_meet_children(). False if segments go opposite ways along an axis, and then nothing is known.
inline bool bound_segments(Segments* s, const PacketBounds* bounds) {
    const float3 to_low = bounds->low - s->origin;
    const float3 to_high = bounds->high - s->origin;
    const float3 a = safe_reciprocal(to_low);
    const float3 b = safe_reciprocal(to_high);
    const int3 down = a < 0.0f;
    s->near_x = down.x ? BOX_STRIDE : 0;
    s->near_y = down.y ? BOX_STRIDE : 0;
    s->near_z = down.z ? BOX_STRIDE : 0;
    const int4 row = (int4)(down, 0);
    s->upper_first = (int16)(row, row, row, row);
    s->origin_rows = rows_of(s->origin, s->origin);
    s->reciprocal_low = rows_of(fmin(a, b), -fmin(a, b));
    s->reciprocal_high = rows_of(fmax(a, b), -fmax(a, b));
    return all(down == (b < 0.0f));
}

/// Ends the segments that meet anything, by the version of the traversal that suits them.
inline void test_visibility(Segments* s, const PacketBounds* bounds, const global BvhNode* nodes,
                            const global BvhTriangle* triangles) {
    if (first_open_group(s, 0) == GATHER_GROUPS) {
        return;
    }
    if (bound_segments(s, bounds)) {
        trace_segments(s, nodes, triangles, true);
    } else {
        trace_segments(s, nodes, triangles, false);
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
        if (packet->nx[i] != 0.0f || packet->ny[i] != 0.0f || packet->nz[i] != 0.0f) {
            const float3 position = (float3)(packet->px[i], packet->py[i], packet->pz[i]);
            bounds.low = fmin(bounds.low, position);  // fmin() and fmax() pass over NaN
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
    const global BvhNode* nodes, const global BvhTriangle* triangles, const global Vpl* vpls, uint first_vpl,
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
            test_visibility(&segments, &bounds, nodes, triangles);
#ifdef GATHER_RECORD
            record_occluded(&segments, pairs);
#endif
            add_visible(&sum, &segments, gather_scale(vpls + i) * GATHER_WEIGHT(packet, k),
                        gather_squared(vpls + i));
        }
        add_to_irradiance(irradiance + packet, first_lane, &sum, chunk == 0);
    }
}
