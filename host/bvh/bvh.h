// SPDX-License-Identifier: Apache-2.0
// Bounding volume hierarchy: built on the host, flattened to the nodes that host and kernels share.
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
    std::vector<BvhTriangle> triangles;  ///< at least one (a degenerate one far away if there is none)
    std::vector<uint> triangle_ids;  ///< for each of those, its index in Scene::triangles; cut ones repeat
    int depth = 0;                   ///< of the deepest leaf; at most NEARLIGHT_MAX_BVH_DEPTH
    double sah_cost = 0;             ///< expected cost of a ray through the root, with the costs below
};

const char* to_string(BvhQuality quality);

struct BvhConfig {
    BvhQuality quality = BvhQuality::fast;
    int bin_count = 32;              ///< an axis; 8 to 64, clamped
    uint max_leaf_triangles = 4;     ///< 1 to 16, clamped; below it the cost decides
    float traversal_cost = 1.0f;     ///< of one node (both child boxes)
    float intersection_cost = 1.0f;  ///< of one triangle
    float max_duplication = 0.3f;    ///< of quality: entries in leaves beyond one a triangle, as a share
};

/// Top-down binned SAH [Wald, On fast Construction of SAH-based Bounding Volume Hierarchies, 2007] over those
/// triangles of the scene that `ids` names, in parallel, the same for any number of threads; `quality` adds
/// spatial_split.h, reinsertion.h and child_order.h. Boxes are two ulps of their largest coordinate larger
/// than need be, so that slab tests never miss a flat one. Needs 100 bytes a triangle while building,
/// `quality` 170. Error(out_of_memory) beyond 2^27 − 1 triangles, where max_duplication counts as if it were
/// used.
Bvh build_bvh(const Scene& scene, std::span<const uint> ids, const BvhConfig& config = {});

/// The triangles that the tree was built over, in ascending order, each once.
std::vector<uint> distinct_triangles(const Bvh& bvh);

/// The two trees of a scene: what light and camera see, and the glass that only the camera sees.
struct SceneBvhs {
    Bvh opaque;
    Bvh glass;
    bool has_glass = false;
};
SceneBvhs build_scene_bvhs(const Scene& scene, const BvhConfig& config = {});

/// Checks every invariant of the layout: each entry in exactly one leaf, each triangle in some, child boxes
/// that hold the triangles below them or, of those in several leaves, together hold every part (tested at
/// points all over it), indices in range, depth within bounds. Returns what is wrong, one line each; empty if
/// sound.
std::vector<std::string> check_bvh(const Bvh& bvh, const Scene& scene, std::span<const uint> ids);

struct BvhHit {
    float t = std::numeric_limits<float>::infinity();
    float u = 0.0f;       ///< weight of v1
    float v = 0.0f;       ///< weight of v2
    uint triangle = ~0u;  ///< index in Scene::triangles
};
/// Closest hit with t in (t_min, t_max), both sides; the direction may have any length, t is in units of it.
/// A ray with a number that is not finite (other than t_max) hits nothing. The plain host traversal that
/// kernels are compared with.
BvhHit closest_hit(const Bvh& bvh, Vec3 origin, Vec3 direction, float t_min, float t_max);
bool occluded(const Bvh& bvh, Vec3 origin, Vec3 direction, float t_min, float t_max);

}  // namespace nearlight::core
