// SPDX-License-Identifier: Apache-2.0
// Traversal of the wide tree by a packet of segments: any hit.
#ifndef NEARLIGHT_LIB_WIDE_TRAVERSE
#define NEARLIGHT_LIB_WIDE_TRAVERSE

#include "lib/packet_blocks.cl"

// Entries of a traversal stack: each level leaves all children but one behind.
#define GATHER_STACK_SIZE ((NEARLIGHT_WIDE_CHILDREN - 1) * NEARLIGHT_MAX_BVH_DEPTH + NEARLIGHT_WIDE_CHILDREN)

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

/// Asks for the memory of a node or of a leaf's first block, which take three cache lines or more.
inline void prefetch_child(const global WideNode* nodes, const global TriangleBlock* blocks, uint child) {
    const bool leaf = (child & NEARLIGHT_LEAF_BIT) != 0;
    prefetch_lines(leaf ? (const global void*)(blocks + (child & NEARLIGHT_LEAF_FIRST_MASK))
                        : (const global void*)(nodes + child));
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
            prefetch_child(nodes, blocks, node->child[slot]);
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

/// Ends the segments that meet anything.
inline void test_visibility(Segments* s, const PacketBounds* bounds, const global WideNode* nodes,
                            const global TriangleBlock* blocks) {
    if (!all_done(s)) {
        make_shaft(&s->shaft, s->origin, bounds);
        trace_segments(s, nodes, blocks);
    }
}

#endif
