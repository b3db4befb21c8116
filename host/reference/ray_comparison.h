// SPDX-License-Identifier: Apache-2.0
// Two ray casters on the same rays: where they differ, and whether single precision excuses it.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "host/bvh/bvh.h"

namespace nearlight::core {

/// How near an edge a ray must pass for both answers to be right, as a fraction of the scene's extent: a few
/// roundings of the products that decide on which side of the edge it passes.
inline constexpr double kEdgeTolerance = 2e-6;

/// m between the ray, as far as the scene (of that extent) reaches, and the nearest edge of a triangle.
double distance_to_triangle_edges(const Scene& scene, uint triangle, const RayQuery& ray, float extent);

/// A ray on which two casters differ.
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

    [[nodiscard]] std::size_t mismatches() const;  ///< disputes without excuse
};

/// Same triangle (or none) and the same distance within rounding for every ray, or a dispute. In dispute is
/// the nearer of the two triangles. Requires spans of one size.
RayComparison compare_hits(const Scene& scene, std::span<const RayQuery> rays,
                           std::span<const BvhHit> expected, std::span<const BvhHit> found);

/// The answers of the oracles, ray by ray.
std::vector<BvhHit> brute_force_hits(const Scene& scene, std::span<const RayQuery> rays);
std::vector<BvhHit> host_hits(const Bvh& bvh, std::span<const RayQuery> rays);
std::vector<BvhHit> embree_hits(const Scene& scene, std::span<const RayQuery> rays);

}  // namespace nearlight::core
