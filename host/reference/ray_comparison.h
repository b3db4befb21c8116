// SPDX-License-Identifier: Apache-2.0
// Compares two ray casters on the same rays: where they differ, and whether single precision excuses it.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "host/bvh/bvh.h"

namespace nearlight::core {

/// Maximum distance from an edge at which both answers about a ray are right, as a fraction of the scene's
/// extent. It is a few roundings of the products that decide on which side of the edge the ray passes.
inline constexpr double kEdgeTolerance = 2e-6;

/// Distance (m) between the ray, up to the end of a scene of the given extent, and the nearest edge of the
/// triangle.
double distance_to_triangle_edges(const Scene& scene, uint triangle, const RayQuery& ray, float extent);

/// A ray about which two casters differ.
struct RayDispute {
    RayQuery ray{};
    BvhHit expected;
    BvhHit found;
    double edge_distance = 0;  ///< between the ray and the nearest edge of the triangle in dispute, m
    bool excused = false;      ///< the ray touches that edge, or both hits are equally far
};
std::string to_string(const RayDispute& dispute);

struct RayComparison {
    std::size_t rays = 0;
    std::size_t hits = 0;  ///< rays that hit something in the expected answers
    std::vector<RayDispute> disputes;

    [[nodiscard]] std::size_t mismatches() const;  ///< number of disputes that are not excused
};

/// Compares hits ray by ray. A ray whose answers differ in the triangle, or in the distance by more than
/// rounding, becomes a dispute about the nearer of the two triangles. The spans must have the same size.
RayComparison compare_hits(const Scene& scene, std::span<const RayQuery> rays,
                           std::span<const BvhHit> expected, std::span<const BvhHit> found);

/// Closest hits by brute force, one per ray.
std::vector<BvhHit> brute_force_hits(const Scene& scene, std::span<const RayQuery> rays);
/// Closest hits by the host's traversal of the tree, one per ray.
std::vector<BvhHit> host_hits(const Bvh& bvh, std::span<const RayQuery> rays);
/// Closest hits among opaque triangles by Embree, one per ray.
std::vector<BvhHit> embree_hits(const Scene& scene, std::span<const RayQuery> rays);

}  // namespace nearlight::core
