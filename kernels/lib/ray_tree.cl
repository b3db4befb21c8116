// SPDX-License-Identifier: Apache-2.0
// The tree that single rays go through: the wide one where NEARLIGHT_WIDE_RAYS is 1 (on CPUs, which have
// vectors for a single ray), else the binary one. A slot is the place of a triangle in it.
#ifndef NEARLIGHT_LIB_RAY_TREE
#define NEARLIGHT_LIB_RAY_TREE

#include "lib/bvh_traverse.cl"
#include "lib/wide_ray.cl"

#if NEARLIGHT_WIDE_RAYS

typedef WideNode TreeNode;
typedef TriangleBlock TreeTriangles;
#define tree_closest_hit wide_closest_hit
#define tree_occluded wide_occluded

static inline float3 column_of(const global float* rows, uint column) {
    return (float3)(rows[column], rows[NEARLIGHT_BLOCK_TRIANGLES + column],
                    rows[2 * NEARLIGHT_BLOCK_TRIANGLES + column]);
}
static inline TreeTriangle tree_triangle(const global TreeTriangles* triangles, uint slot) {
    const global TriangleBlock* block = triangles + slot / NEARLIGHT_BLOCK_TRIANGLES;
    const uint column = slot % NEARLIGHT_BLOCK_TRIANGLES;
    TreeTriangle triangle;
    triangle.v0 = column_of(block->v0[0], column);
    triangle.edge1 = column_of(block->edge1[0], column);
    triangle.edge2 = column_of(block->edge2[0], column);
    triangle.normal = cross(triangle.edge1, triangle.edge2);
    return triangle;
}

#else

typedef BvhNode TreeNode;
typedef BvhTriangle TreeTriangles;
#define tree_closest_hit closest_hit
#define tree_occluded occluded

static inline TreeTriangle tree_triangle(const global TreeTriangles* triangles, uint slot) {
    return load_triangle(triangles + slot);
}

#endif
#endif
