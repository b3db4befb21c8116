// SPDX-License-Identifier: Apache-2.0
// Traversal of the wide tree by a packet of segments: any hit.
//
// Nodes come from a stack, a few at a time, and the leaves that they lead to are looked at after them. That
// makes long runs of work that does not depend on the step before, which hides latencies, and asks for memory
// well before it is used.
#ifndef NEARLIGHT_LIB_WIDE_TRAVERSE
#define NEARLIGHT_LIB_WIDE_TRAVERSE

#include "lib/packet_blocks.cl"

#define NODES_AT_ONCE 4
// Entries lie deeper in the tree the nearer they are to the top, so that when nodes of a level are taken,
// nothing is left of the level below: no level ever has more entries than one taking adds.
#define GATHER_STACK_SIZE (NEARLIGHT_WIDE_CHILDREN * NODES_AT_ONCE * (NEARLIGHT_MAX_BVH_DEPTH + 1))

/// An inner node, and the clusters that may meet it.
typedef struct NodeVisit {
    uint node, clusters;
} NodeVisit;

typedef struct Traversal {
    NodeVisit stack[GATHER_STACK_SIZE];
    uint top;
    LeafVisit
        leaves[NODES_AT_ONCE * NEARLIGHT_WIDE_CHILDREN * GATHER_GROUPS + 1];  // and one that does not count
    uint leaf_count;
} Traversal;

// Both write always and count only what is kept, which costs less than a branch that nobody can predict.
LANES_INLINE void keep_node(Traversal* work, uint node, uint clusters) {
    const NodeVisit visit = {node, clusters};
    work->stack[work->top] = visit;
    work->top += clusters != 0 ? 1 : 0;
}
LANES_INLINE void keep_leaf(Traversal* work, uint leaf, uint group, uint lanes) {
    const LeafVisit visit = {leaf, group, lanes};
    work->leaves[work->leaf_count] = visit;
    work->leaf_count += lanes != 0 ? 1 : 0;
}

/// Keeps a child that some of `clusters` meet. An inner child is tested with the lanes of two groups, and may
/// pass for the sake of others; a leaf with those of all.
LANES_INLINE void visit_child(Traversal* work, const Segments* s, const ChildPlanes* relative, uint slot,
                              uint child, uint clusters) {
    const Planes planes = planes_of(relative, slot);
    const uint meeting = clusters & clusters_in_box(&s->clusters, s->shaft.straddles != 0, &planes);
    if (meeting == 0) {
        return;
    }
    const uint group0 = first_group(meeting);
    const uint others = meeting & ~clusters_of_group(group0);
    const uint group1 = others != 0 ? first_group(others) : group0;
    const uint lanes0 = lanes_in_box(s, group0, &planes);
    const uint lanes1 = lanes_in_box(s, group1, &planes);
    if ((child & NEARLIGHT_LEAF_BIT) == 0) {
        keep_node(work, child,
                  meeting & ~(lanes0 == 0 ? clusters_of_group(group0) : 0) &
                      ~(lanes1 == 0 ? clusters_of_group(group1) : 0));
        return;
    }
    keep_leaf(work, child, group0, lanes0);
    keep_leaf(work, child, group1, others != 0 ? lanes1 : 0);
    uint rest = others & ~clusters_of_group(group1);
    while (rest != 0) {
        const uint group = first_group(rest);
        rest &= ~clusters_of_group(group);
        keep_leaf(work, child, group, lanes_in_box(s, group, &planes));
    }
}

/// The same where only one cluster is left, which is known to meet the child.
LANES_INLINE void visit_child_alone(Traversal* work, const Segments* s, const ChildPlanes* relative,
                                    uint slot, uint child, uint cluster) {
    const Planes planes = planes_of(relative, slot);
    const uint group = first_group(cluster);
    const uint lanes = lanes_in_box(s, group, &planes);
    if ((child & NEARLIGHT_LEAF_BIT) == 0) {
        keep_node(work, child, lanes != 0 ? cluster : 0);
    } else {
        keep_leaf(work, child, group, lanes);
    }
}

/// Keeps those of a node's children in `met` that segments of `clusters` meet.
LANES_INLINE void visit_children(Traversal* work, const Segments* s, const global WideNode* nodes,
                                 const global TriangleBlock* blocks, NodeVisit visit,
                                 const ChildPlanes* relative, uint met, bool alone) {
    const global WideNode* node = nodes + visit.node;
    for (; met != 0; met &= met - 1) {
        const uint slot = lowest_bit(met);
        const uint child = node->child[slot];
        prefetch_child(nodes, blocks, child);
        if (alone) {
            visit_child_alone(work, s, relative, slot, child, visit.clusters);
        } else {
            visit_child(work, s, relative, slot, child, visit.clusters);
        }
    }
}

/// Takes nodes from the stack and keeps those of their children that segments meet.
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
            visit_children(work, s, nodes, blocks, visit, &relative, lane_bits8(met), true);
        } else {
            const int8 met = children_in_shaft(&s->shaft, s->origin, node, &relative);
            visit_children(work, s, nodes, blocks, visit, &relative, lane_bits8(met), false);
        }
    }
}

/// Ends the segments that hit a triangle of the leaves that were kept.
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

/// Ends the segments (t_max = −1) that meet anything.
LANES_INLINE void trace_segments(Segments* s, const PacketBounds* bounds, const global WideNode* nodes,
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
