// SPDX-License-Identifier: Apache-2.0
#include "host/reference/ray_comparison.h"

#include <algorithm>
#include <sstream>

#include "host/bvh/segment_distance.h"
#include "host/reference/brute_force.h"
#include "host/reference/embree_scene.h"

namespace nearlight::core {
namespace {

/// Relative rounding error of the distance to a surface that the ray meets head-on.
constexpr double kDistanceTolerance = 2e-6;
/// Below this cosine, single precision cannot tell a ray from one in the triangle's plane.
constexpr double kGrazingCosine = 1e-4;

std::array<Vec3, 3> corners(const Scene& scene, uint id) {
    const Triangle& triangle = scene.triangles[id];
    return {scene.vertices[triangle.v0].position, scene.vertices[triangle.v1].position,
            scene.vertices[triangle.v2].position};
}

double cosine_to(const Scene& scene, uint id, Vec3 direction) {
    const auto [a, b, c] = corners(scene, id);
    return std::abs(dot(normalize(cross(b - a, c - a)), normalize(direction)));
}

bool agree(const Scene& scene, const RayQuery& ray, const BvhHit& expected, const BvhHit& found) {
    if (expected.triangle != found.triangle) {
        return false;
    }
    if (found.triangle == ~0u) {
        return true;
    }
    const double cosine = cosine_to(scene, found.triangle, ray.direction);
    const double unit = length(ray.direction);
    const double tolerance = kDistanceTolerance * (1 + double{expected.t} * unit) / cosine;
    return cosine > kGrazingCosine && std::abs(double{found.t} - expected.t) * unit <= tolerance;
}

RayDispute judge(const Scene& scene, float extent, const RayQuery& ray, const BvhHit& expected,
                 const BvhHit& found) {
    RayDispute dispute{.ray = ray, .expected = expected, .found = found};
    const BvhHit& nearer = found.t < expected.t ? found : expected;
    dispute.edge_distance = distance_to_triangle_edges(scene, nearer.triangle, ray, extent);
    const double gap = std::abs(double{found.t} - expected.t) * length(ray.direction);
    const bool equally_far =
        expected.triangle != ~0u && found.triangle != ~0u && gap <= kDistanceTolerance * extent;
    dispute.excused = dispute.edge_distance <= kEdgeTolerance * extent || equally_far;
    return dispute;
}

std::string to_string(const BvhHit& hit) {
    return hit.triangle == ~0u ? "nothing"
                               : "triangle " + std::to_string(hit.triangle) + " at " + std::to_string(hit.t);
}

}  // namespace

double distance_to_triangle_edges(const Scene& scene, uint triangle, const RayQuery& ray, float extent) {
    const auto [a, b, c] = corners(scene, triangle);
    const float reach = 2.0f * (extent + length(ray.origin - a));
    const Vec3 end = ray.origin + normalize(ray.direction) * reach;
    return std::min({segment_distance(ray.origin, end, a, b), segment_distance(ray.origin, end, b, c),
                     segment_distance(ray.origin, end, c, a)});
}

std::string to_string(const RayDispute& dispute) {
    std::ostringstream text;
    text.precision(9);
    const auto [ox, oy, oz] = dispute.ray.origin;
    const auto [dx, dy, dz] = dispute.ray.direction;
    text << "(" << ox << ", " << oy << ", " << oz << ") + t·(" << dx << ", " << dy << ", " << dz
         << "): expected " << to_string(dispute.expected) << ", found " << to_string(dispute.found) << ", "
         << dispute.edge_distance << " m from an edge" << (dispute.excused ? "" : ", NO TIE");
    return text.str();
}

std::size_t RayComparison::mismatches() const {
    return static_cast<std::size_t>(
        std::count_if(disputes.begin(), disputes.end(), [](const RayDispute& d) { return !d.excused; }));
}

RayComparison compare_hits(const Scene& scene, std::span<const RayQuery> rays,
                           std::span<const BvhHit> expected, std::span<const BvhHit> found) {
    const float extent = max_component(bounds(scene).size());
    RayComparison comparison{.rays = rays.size(), .disputes = {}};
    for (std::size_t i = 0; i < rays.size(); ++i) {
        comparison.hits += expected[i].triangle != ~0u ? 1 : 0;
        if (!agree(scene, rays[i], expected[i], found[i])) {
            comparison.disputes.push_back(judge(scene, extent, rays[i], expected[i], found[i]));
        }
    }
    return comparison;
}

std::vector<BvhHit> brute_force_hits(const Scene& scene, std::span<const RayQuery> rays) {
    std::vector<BvhHit> hits;
    for (const RayQuery& ray : rays) {
        hits.push_back(brute_force_closest_hit(scene, {}, ray.origin, ray.direction, ray.t_min, ray.t_max));
    }
    return hits;
}

std::vector<BvhHit> host_hits(const Bvh& bvh, std::span<const RayQuery> rays) {
    std::vector<BvhHit> hits;
    for (const RayQuery& ray : rays) {
        hits.push_back(closest_hit(bvh, ray.origin, ray.direction, ray.t_min, ray.t_max));
    }
    return hits;
}

std::vector<BvhHit> embree_hits(const Scene& scene, std::span<const RayQuery> rays) {
    const EmbreeScene embree(scene);
    std::vector<BvhHit> hits;
    for (const RayQuery& ray : rays) {
        hits.push_back(embree.closest_hit(ray.origin, ray.direction, ray.t_min, ray.t_max));
    }
    return hits;
}

}  // namespace nearlight::core
