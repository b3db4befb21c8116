// SPDX-License-Identifier: Apache-2.0
// The bounding volume hierarchy, built on the host and flattened to the nodes that host and kernels share.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "host/base/math.h"
#include "host/scene/scene.h"
#include "kernels/shared/types.h"
#include "nearlight/settings.h"

namespace nearlight::core {

struct Bvh {
    std::vector<BvhNode> nodes;          ///< at least one; node 0 is the root
    std::vector<BvhTriangle> triangles;  ///< at least one; without triangles a degenerate one far away
    std::vector<uint> triangle_ids;      ///< index of each in Scene::triangles; cut ones repeat
    int depth = 0;                       ///< depth of the deepest leaf; at most NEARLIGHT_MAX_BVH_DEPTH
    double sah_cost = 0;  ///< expected cost of a ray through the root, with the costs of BvhConfig
};

const char* to_string(BvhQuality quality);

struct BvhConfig {
    BvhQuality quality = BvhQuality::fast;
    int bin_count = 32;              ///< bins on an axis; 8 to 64, clamped
    uint max_leaf_triangles = 4;     ///< 1 to 16, clamped; the cost decides whether leaves have fewer
    float traversal_cost = 1.0f;     ///< cost of one node (both child boxes)
    float intersection_cost = 1.0f;  ///< cost of one triangle
    float max_duplication = 0.3f;    ///< for `quality`: max entries beyond one a triangle, as a share
};

/// Builds a tree over the triangles of the scene that `ids` names, by top-down binned SAH [Wald, On fast
/// Construction of SAH-based Bounding Volume Hierarchies, 2007]. The work is parallel, with the same result
/// for any number of threads; `quality` adds spatial_split.h, reinsertion.h and child_order.h. Boxes are
/// padded by two ulps of their largest coordinate, so that slab tests never miss a flat one. Building takes
/// 100 bytes a triangle, `quality` 170. Throws Error(ErrorKind::out_of_memory) beyond 2^27 − 1 triangles.
/// Near that number fewer triangles are cut than max_duplication allows.
Bvh build_bvh(const Scene& scene, std::span<const uint> ids, const BvhConfig& config = {});

/// The ids of the triangles that the tree was built over, in ascending order, each once.
std::vector<uint> distinct_triangles(const Bvh& bvh);

/// Builds the tree over all triangles of the scene.
Bvh build_scene_bvh(const Scene& scene, const BvhConfig& config = {});

/// Checks every invariant of the layout: each entry is in exactly one leaf, and each triangle in at least
/// one; child boxes hold the triangles below them, and those of a cut triangle together hold every part
/// (tested at points all over it); indices are in range, and so is the depth. Returns one line for each
/// fault; empty if the tree is sound.
std::vector<std::string> check_bvh(const Bvh& bvh, const Scene& scene, std::span<const uint> ids);

struct BvhHit {
    float t = std::numeric_limits<float>::infinity();
    float u = 0.0f;       ///< weight of v1
    float v = 0.0f;       ///< weight of v2
    uint triangle = ~0u;  ///< index in Scene::triangles
};
/// The closest hit with t in (t_min, t_max), on either side of a triangle; `triangle` is ~0u if there is
/// none. The direction may have any length, and t is in units of it. A ray with a number that is not finite
/// (other than t_max) hits nothing. Kernels are compared with this plain traversal.
BvhHit closest_hit(const Bvh& bvh, Vec3 origin, Vec3 direction, float t_min, float t_max);
/// Whether there is any such hit.
bool occluded(const Bvh& bvh, Vec3 origin, Vec3 direction, float t_min, float t_max);

}  // namespace nearlight::core
