// SPDX-License-Identifier: Apache-2.0
// Any-hit traversal of the wide tree by the segments of a beam.
//
// Nodes are taken from a stack, a few at a time, and the leaves that they lead to are tested after them. Long
// runs of work thus do not depend on the step before, which hides latencies, and memory is prefetched well
// before it is used.
#ifndef NEARLIGHT_LIB_WIDE_TRAVERSE
#define NEARLIGHT_LIB_WIDE_TRAVERSE

#include "lib/beam_blocks.cl"

#define NODES_AT_ONCE 4
// The nearer an entry is to the top of the stack, the deeper its node lies in the tree. When nodes of a level
// are taken, nothing is left of the level below, so no level ever has more entries than one such step adds.
#define GATHER_STACK_SIZE (NEARLIGHT_WIDE_CHILDREN * NODES_AT_ONCE * (NEARLIGHT_MAX_BVH_DEPTH + 1))

/// An inner node, and one bit for each cluster that may meet it.
typedef struct NodeVisit {
    uint node, clusters;
} NodeVisit;

typedef struct Traversal {
    NodeVisit stack[GATHER_STACK_SIZE];
    uint top;
    // keep_leaf() also writes leaves that it does not count, which takes one entry more.
    LeafVisit leaves[NODES_AT_ONCE * NEARLIGHT_WIDE_CHILDREN * GATHER_ROWS + 1];
    uint leaf_count;
} Traversal;

// keep_node() and keep_leaf() always write and only count what is kept, which costs less than a branch that
// cannot be predicted.
LANES_INLINE void keep_node(Traversal* work, uint node, uint clusters) {
    const NodeVisit visit = {node, clusters};
    work->stack[work->top] = visit;
    work->top += clusters != 0 ? 1 : 0;
}
LANES_INLINE void keep_leaf(Traversal* work, uint leaf, uint row, uint lanes) {
    const LeafVisit visit = {leaf, row, lanes};
    work->leaves[work->leaf_count] = visit;
    work->leaf_count += lanes != 0 ? 1 : 0;
}

/// Keeps an inner child that some clusters may meet, without the clusters of the first two rows whose lanes
/// all miss it. The lanes of other rows are not tested.
LANES_INLINE void visit_inner(Traversal* work, const Segments* s, const Planes* planes, uint child,
                              uint meeting) {
    const uint row0 = first_row(meeting);
    const uint others = meeting & ~clusters_of_row(row0);
    const uint row1 = others != 0 ? first_row(others) : row0;
    const uint lanes0 = lanes_in_box(s, row0, planes);
    const uint lanes1 = lanes_in_box(s, row1, planes);
    keep_node(
        work, child,
        meeting & ~(lanes0 == 0 ? clusters_of_row(row0) : 0) & ~(lanes1 == 0 ? clusters_of_row(row1) : 0));
}

/// Keeps a leaf with the lanes that meet it, in each row that has a cluster in `meeting`.
LANES_INLINE void visit_leaf(Traversal* work, const Segments* s, const Planes* planes, uint child,
                             uint meeting) {
    do {
        const uint row = first_row(meeting);
        meeting &= ~clusters_of_row(row);
        keep_leaf(work, child, row, lanes_in_box(s, row, planes));
    } while (meeting != 0);
}

/// Keeps the children of a node that segments of several clusters meet; `met` has a bit for each child that
/// the shaft of the beam meets. All children are tested with the clusters first, because a branch after each
/// of these tests could not be predicted.
LANES_INLINE void visit_children(Traversal* work, const Segments* s, const global WideNode* nodes,
                                 const global TriangleBlock* blocks, NodeVisit visit,
                                 const ChildPlanes* relative, uint met) {
    const global WideNode* node = nodes + visit.node;
    uint meeting[NEARLIGHT_WIDE_CHILDREN];
    uint kept = 0;
    for (; met != 0; met &= met - 1) {
        const uint slot = lowest_bit(met);
        prefetch_child(nodes, blocks, node->child[slot]);
        const Planes planes = planes_of(relative, slot);
        meeting[slot] = visit.clusters & clusters_in_box(&s->clusters, s->shaft.straddles != 0, &planes);
        kept |= (meeting[slot] != 0 ? 1u : 0u) << slot;
    }
    const uint leaves = lane_bits8(vload8(0, (const global int*)node->child) < 0);
    for (uint inner = kept & ~leaves; inner != 0; inner &= inner - 1) {
        const uint slot = lowest_bit(inner);
        const Planes planes = planes_of(relative, slot);
        visit_inner(work, s, &planes, node->child[slot], meeting[slot]);
    }
    for (uint leaf = kept & leaves; leaf != 0; leaf &= leaf - 1) {
        const uint slot = lowest_bit(leaf);
        const Planes planes = planes_of(relative, slot);
        visit_leaf(work, s, &planes, node->child[slot], meeting[slot]);
    }
}

/// Keeps the children of a node that segments of the one cluster left meet; `met` has a bit for each child
/// that the shaft of this cluster meets.
LANES_INLINE void visit_children_alone(Traversal* work, const Segments* s, const global WideNode* nodes,
                                       const global TriangleBlock* blocks, NodeVisit visit,
                                       const ChildPlanes* relative, uint met) {
    const global WideNode* node = nodes + visit.node;
    const uint row = first_row(visit.clusters);
    for (; met != 0; met &= met - 1) {
        const uint slot = lowest_bit(met);
        const uint child = node->child[slot];
        prefetch_child(nodes, blocks, child);
        const Planes planes = planes_of(relative, slot);
        const uint lanes = lanes_in_box(s, row, &planes);
        if ((child & NEARLIGHT_LEAF_BIT) == 0) {
            keep_node(work, child, lanes != 0 ? visit.clusters : 0);
        } else {
            keep_leaf(work, child, row, lanes);
        }
    }
}

/// Takes nodes from the stack and keeps the children that segments meet.
LANES_INLINE void visit_nodes(Traversal* work, const Segments* s, const global WideNode* nodes,
                              const global TriangleBlock* blocks) {
    NodeVisit taken[NODES_AT_ONCE];
    const uint count = min(work->top, (uint)NODES_AT_ONCE);
    work->top -= count;
    for (uint i = 0; i < count; ++i) {
        taken[i] = work->stack[work->top + i];
    }
    for (uint i = 0; i < count; ++i) {
        const global WideNode* node = nodes + taken[i].node;
        ChildPlanes relative;
        const NodeVisit visit = {taken[i].node, taken[i].clusters & s->open};
        if (visit.clusters == 0) {
            continue;
        }
        if ((visit.clusters & (visit.clusters - 1)) == 0) {
            const uint cluster = lowest_bit(visit.clusters);
            const int8 met =
                children_in_cluster(&s->clusters, &s->shaft, cluster, s->origin, node, &relative);
            visit_children_alone(work, s, nodes, blocks, visit, &relative, lane_bits8(met));
        } else {
            const int8 met = children_in_shaft(&s->shaft, s->origin, node, &relative);
            visit_children(work, s, nodes, blocks, visit, &relative, lane_bits8(met));
        }
    }
}

/// Ends the segments that hit a triangle of one of the leaves that were kept.
LANES_INLINE void visit_leaves(Traversal* work, Segments* s, const global TriangleBlock* blocks) {
    uint first = 0;
    while (first < work->leaf_count) {
        uint end = first + 1;
        while (end < work->leaf_count && work->leaves[end].leaf == work->leaves[first].leaf) {
            ++end;
        }
        intersect_leaf(s, blocks, work->leaves + first, end - first);
        first = end;
    }
    work->leaf_count = 0;
}

/// Ends the open segments that hit anything in the scene.
LANES_INLINE void trace_segments(Segments* s, const BeamBounds* bounds, const global WideNode* nodes,
                                 const global TriangleBlock* blocks) {
    if (s->open == 0) {
        return;
    }
    make_shaft(&s->shaft, s->origin, bounds);
    make_cluster_shafts(&s->clusters, &s->shaft, s->origin, bounds);
    Traversal work;
    work.stack[0].node = 0;
    work.stack[0].clusters = s->open;
    work.top = 1;
    work.leaf_count = 0;
    while (work.top != 0 && s->open != 0) {
        visit_nodes(&work, s, nodes, blocks);
        visit_leaves(&work, s, blocks);
    }
}

#endif
