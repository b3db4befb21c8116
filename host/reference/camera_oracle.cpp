// SPDX-License-Identifier: Apache-2.0
#include "host/reference/camera_oracle.h"

#include "host/base/receivers.h"
#include "host/reference/bsdf/surface_bsdf.h"
#include "host/reference/close_range_oracle.h"
#include "host/reference/ray_comparison.h"

namespace nearlight::core {
namespace {

/// Tolerance of coordinates and distances, relative to the scene's extent. It allows for the rounding of a
/// direction in single precision that is multiplied by a distance.
constexpr float kTolerance = 2e-5f;

struct Found : ReceiverPoint {
    const CameraVertex& vertex;
};

bool is_absent(const Found& found) {
    return is_zero(found.normal) && is_zero(found.vertex.throughput) &&
           (found.vertex.flags & NEARLIGHT_VERTEX_CLOSE) == 0;
}

/// Where no surface has S, random numbers do not matter.
SurfaceBsdf bsdf_at(const Scene& scene, const Surface& surface, const RayQuery& ray) {
    return {scene, surface, -normalize(as_double(ray.direction)), 0.5};
}

bool fits(const Scene& scene, const CloseRange& region, const RayQuery& ray, const BvhHit& hit,
          const Found& found, Vec3 scene_size) {
    const Surface surface = surface_at(scene, hit, ray.direction);
    const float slack = kTolerance * max_component(scene_size);
    const Vec3 position = surface.off(surface.geometric_normal, scene_size);
    const SurfaceBsdf bsdf = bsdf_at(scene, surface, ray);
    const bool is_close = (found.vertex.flags & NEARLIGHT_VERTEX_CLOSE) != 0;
    const float cosine = std::max(std::abs(dot(surface.geometric_normal, ray.direction)), 1e-3f);
    return length(found.position - position) <= slack / cosine &&
           length(found.normal - as_float(bsdf.normal())) <= 1e-4f &&
           length(found.vertex.albedo - as_float(bsdf.diffuse_reflectance())) <= 1e-4f &&
           std::abs(found.vertex.depth - hit.t) <= slack / cosine &&
           close_flag_fits(region, surface.position, is_close, slack / cosine);
}

bool touches_edge(const Scene& scene, const BvhHit& hit, const RayQuery& ray, float extent) {
    return distance_to_triangle_edges(scene, hit.triangle, ray, extent) <= kEdgeTolerance * extent;
}

}  // namespace

CameraComparison compare_with_embree(const Scene& scene, const Camera& camera, const CloseRange& close_range,
                                     std::span<const ReceiverPacket> receivers,
                                     std::span<const CameraVertex> vertices) {
    const EmbreeScene embree(scene);
    const Vec3 scene_size = bounds(scene).size();
    const float extent = max_component(scene_size);
    constexpr uint kTile = NEARLIGHT_TILE_SIZE;
    const uint tiles_x = (camera.width + kTile - 1) / kTile;
    CameraComparison comparison;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        const std::size_t packet = i / NEARLIGHT_PACKET_SIZE;
        const std::size_t lane = i % NEARLIGHT_PACKET_SIZE;
        const uint x = static_cast<uint>(packet % tiles_x * kTile + lane % kTile);
        const uint y = static_cast<uint>(packet / tiles_x * kTile + lane / kTile);
        const Found found{receiver_at(receivers, i), vertices[i]};
        const RayQuery ray = pixel_ray(camera, x, y);
        const BvhHit hit = x < camera.width && y < camera.height
                               ? embree.closest_hit(ray.origin, ray.direction, ray.t_min, ray.t_max)
                               : BvhHit{};
        const bool absent =
            hit.triangle == ~0u || !bsdf_at(scene, surface_at(scene, hit, ray.direction), ray).has_diffuse();
        const bool right = absent ? is_absent(found) : fits(scene, close_range, ray, hit, found, scene_size);
        ++(absent ? comparison.absent : comparison.receivers);
        comparison.mismatches += right || (!absent && touches_edge(scene, hit, ray, extent)) ? 0 : 1;
    }
    return comparison;
}

}  // namespace nearlight::core
