// SPDX-License-Identifier: Apache-2.0
// Casts given rays: the traversal of lib/ray_tree.cl by itself, for openings (host/session/openings.cpp), for
// what lights a point (host/session/light_shares.cpp), and to compare it with other ray casters ray by ray.
//
// One work-item for each ray; any work-group size.

#include "lib/ray_tree.cl"

kernel void cast_closest(const global TreeNode* restrict nodes,
                         const global TreeTriangles* restrict triangles, const global RayQuery* restrict rays,
                         uint ray_count, global RayHit* restrict hits) {
    const uint index = (uint)get_global_id(0);
    if (index >= ray_count) {
        return;
    }
    const RayQuery ray = rays[index];
    hits[index] =
        tree_closest_hit(nodes, triangles, load3(ray.origin), load3(ray.direction), ray.t_min, ray.t_max);
}

/// Sets is_occluded[i] to 1 where ray i meets anything, else to 0.
kernel void cast_any(const global TreeNode* restrict nodes, const global TreeTriangles* restrict triangles,
                     const global RayQuery* restrict rays, uint ray_count,
                     global uint* restrict is_occluded) {
    const uint index = (uint)get_global_id(0);
    if (index >= ray_count) {
        return;
    }
    const RayQuery ray = rays[index];
    is_occluded[index] =
        tree_occluded(nodes, triangles, load3(ray.origin), load3(ray.direction), ray.t_min, ray.t_max) ? 1
                                                                                                       : 0;
}
