// SPDX-License-Identifier: Apache-2.0
// Nodes and triangles of the wide tree, for beams and for single rays.
#ifndef NEARLIGHT_LIB_WIDE_TREE
#define NEARLIGHT_LIB_WIDE_TREE

#include "lib/lanes.cl"
#include "shared/types.h"

// The number of floats from a lower plane of a WideNode to the upper one.
#define WIDE_UPPER (3 * NEARLIGHT_WIDE_CHILDREN)

/// The first block of a leaf.
LANES_INLINE uint first_block(uint leaf) {
    return leaf & NEARLIGHT_LEAF_FIRST_MASK;
}
/// The last block of a leaf, which still belongs to it.
LANES_INLINE uint last_block(uint leaf) {
    return first_block(leaf) + ((leaf >> NEARLIGHT_LEAF_COUNT_SHIFT) & NEARLIGHT_LEAF_COUNT_MASK);
}

/// Prefetches a node, or the first block of a leaf. Either takes about four cache lines.
LANES_INLINE void prefetch_child(const global WideNode* nodes, const global TriangleBlock* blocks,
                                 uint child) {
    const bool leaf = (child & NEARLIGHT_LEAF_BIT) != 0;
    prefetch_lines(leaf ? (const global void*)(blocks + first_block(child))
                        : (const global void*)(nodes + child));
}

/// One vector for each triangle of a block.
typedef struct Axis4 {
    float4 x, y, z;
} Axis4;

LANES_INLINE Axis4 load_axis(const global float* rows) {
    const Axis4 axis = {vload4(0, rows), vload4(1, rows), vload4(2, rows)};
    return axis;
}
LANES_INLINE Axis4 cross4(Axis4 a, Axis4 b) {
    const Axis4 axis = {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
    return axis;
}

#endif
