// SPDX-License-Identifier: Apache-2.0
#include "host/reference/gather_workload.h"

#include <algorithm>
#include <cmath>

#include "host/base/cosine_direction.h"
#include "host/base/receivers.h"
#include "host/scene/camera.h"
#include "host/scene/distribution.h"
#include "host/scene/emitters.h"
#include "host/scene/ray_epsilon.h"
#include "host/scene/reflectance.h"

namespace nearlight::core {
namespace {

constexpr uint kMaxWalkDepth = 5;

uint spread_bits(uint x) {
    x = (x | (x << 16u)) & 0x030000ffu;
    x = (x | (x << 8u)) & 0x0300f00fu;
    x = (x | (x << 4u)) & 0x030c30c3u;
    return (x | (x << 2u)) & 0x09249249u;
}

/// Morton code of 30 bits for a point in [0, 1]³.
uint morton_code(Vec3 unit) {
    const auto cell = [](float x) { return static_cast<uint>(std::clamp(x * 1024.0f, 0.0f, 1023.0f)); };
    return spread_bits(cell(unit.x)) | (spread_bits(cell(unit.y)) << 1u) | (spread_bits(cell(unit.z)) << 2u);
}

Vec3 triangle_normal(const Scene& scene, const Triangle& triangle) {
    const Vec3 v0 = scene.vertices[triangle.v0].position;
    return normalize(
        cross(scene.vertices[triangle.v1].position - v0, scene.vertices[triangle.v2].position - v0));
}

Vec3 triangle_point(const Scene& scene, const Triangle& triangle, float u, float v) {
    return scene.vertices[triangle.v0].position * (1.0f - u - v) + scene.vertices[triangle.v1].position * u +
           scene.vertices[triangle.v2].position * v;
}

class PointMaker {
  public:
    explicit PointMaker(const Scene& scene) : scene_(scene), size_(bounds(scene).size()) {}

    /// A point a small distance off the surface, on the side that a ray along `direction` hits.
    [[nodiscard]] ReceiverPoint at_hit(const BvhHit& hit, Vec3 direction) const {
        const Triangle& triangle = scene_.triangles[hit.triangle];
        Vec3 normal = triangle_normal(scene_, triangle);
        if (dot(normal, direction) > 0.0f) {
            normal = -normal;
        }
        return off_triangle(hit.triangle, hit.u, hit.v, normal);
    }
    [[nodiscard]] ReceiverPoint on_front(uint triangle, Pcg32& random) const {
        const float root = std::sqrt(random.uniform());
        const float u = 1.0f - root;
        const float v = root * random.uniform();
        return off_triangle(triangle, u, v, triangle_normal(scene_, scene_.triangles[triangle]));
    }

  private:
    [[nodiscard]] ReceiverPoint off_triangle(uint triangle, float u, float v, Vec3 normal) const {
        const float off = triangle_stand_off(scene_, triangle, size_);
        return {triangle_point(scene_, scene_.triangles[triangle], u, v) + normal * off, normal};
    }

    const Scene& scene_;
    Vec3 size_;  ///< of the scene's bounds, m
};

Vec3 sphere_direction(Pcg32& random) {
    const float z = 1.0f - 2.0f * random.uniform();
    const float phi = 2.0f * kPi * random.uniform();
    const float r = std::sqrt(std::max(0.0f, 1.0f - z * z));
    return {r * std::cos(phi), r * std::sin(phi), z};
}

Vpl make_vpl(const ReceiverPoint& point, uint depth) {
    // All powers are equal, because the work does not depend on them.
    return {point.position, depth, point.normal, 0, {1.0f, 1.0f, 1.0f}, 0};
}

RayQuery endless_ray(Vec3 origin, Vec3 direction) {
    return {origin, 0.0f, direction, kInfinity};
}

BvhHit closest_hit(const Bvh& bvh, const RayQuery& ray) {
    return closest_hit(bvh, ray.origin, ray.direction, ray.t_min, ray.t_max);
}

RayQuery start_walk(const PointMaker& points, const Emitter& emitter, Pcg32& random) {
    if (is_area_light(emitter)) {
        const uint offset = emitter.triangle_count > 1 ? random.next() % emitter.triangle_count : 0;
        const ReceiverPoint point = points.on_front(emitter.triangle + offset, random);
        return endless_ray(point.position, cosine_direction(point.normal, random));
    }
    return endless_ray(emitter.position, sphere_direction(random));
}

/// The emitters from which walks start: those that have a place.
std::vector<Emitter> lamps(const EmitterTable& table) {
    std::vector<Emitter> result;
    for (const Emitter& emitter : table.emitters) {
        if (emitter.type != NEARLIGHT_EMITTER_ENVIRONMENT && emitter.type != NEARLIGHT_EMITTER_DIRECTIONAL &&
            emitter.type != NEARLIGHT_EMITTER_SUN) {
            result.push_back(emitter);
        }
    }
    return result;
}

/// Calls visit(ray, deposit) for each ray of a walk until it returns false; `deposit` is null where the ray
/// leaves the scene. Returns false if `visit` did.
template <typename Visit>
bool follow_walk(const Scene& scene, const Bvh& bvh, const PointMaker& points, RayQuery ray, Pcg32& random,
                 const Visit& visit) {
    for (uint depth = 1; depth <= kMaxWalkDepth; ++depth) {
        const BvhHit hit = closest_hit(bvh, ray);
        if (hit.triangle == ~0u) {
            return visit(ray, nullptr);
        }
        const ReceiverPoint point = points.at_hit(hit, ray.direction);
        const Vpl deposit = make_vpl(point, depth);
        if (!visit(ray, &deposit)) {
            return false;
        }
        const Material& material = scene.materials[scene.triangles[hit.triangle].material];
        if (random.uniform() >= max_component(mean_reflectance(scene, material, 0.0f, 0.0f))) {
            return true;
        }
        ray = endless_ray(point.position, cosine_direction(point.normal, random));
    }
    return true;
}

/// Calls follow_walk() for at most `max_walks` walks from the scene's lights, until `visit` returns false.
template <typename Visit>
void follow_walks(const Scene& scene, const Bvh& bvh, std::size_t max_walks, Pcg32& random,
                  const Visit& visit) {
    const std::vector<Emitter> emitters = lamps(build_emitter_table(scene));
    if (emitters.empty()) {
        return;
    }
    const PointMaker points(scene);
    std::vector<double> weights;
    for (const Emitter& emitter : emitters) {
        weights.push_back(emitter.probability);
    }
    const std::vector<float> cdf = cumulative_distribution(weights);
    for (std::size_t walk = 0; walk < max_walks; ++walk) {
        const Emitter& emitter = emitters[select(cdf, random.uniform())];
        if (!follow_walk(scene, bvh, points, start_walk(points, emitter, random), random, visit)) {
            return;
        }
    }
}

std::vector<Vpl> trace_walks(const Scene& scene, const Bvh& bvh, std::size_t count, Pcg32& random) {
    std::vector<Vpl> vpls;
    // The number of walks is limited because a light in the open may hit nothing.
    follow_walks(scene, bvh, 100 * count, random, [&](const RayQuery&, const Vpl* deposit) {
        if (deposit != nullptr) {
            vpls.push_back(*deposit);
        }
        return vpls.size() < count;
    });
    return vpls;
}

std::vector<Vpl> spread_over_surfaces(const Scene& scene, std::size_t count, Pcg32& random) {
    const PointMaker points(scene);
    std::vector<double> cumulative;
    double area = 0.0;
    for (const Triangle& triangle : scene.triangles) {
        cumulative.push_back(area += triangle_area(scene, triangle));
    }
    std::vector<Vpl> vpls;
    for (std::size_t i = 0; i < count && area > 0.0; ++i) {
        const double wanted = (static_cast<double>(i) + random.uniform()) / static_cast<double>(count) * area;
        const auto at =
            std::upper_bound(cumulative.begin(), cumulative.end() - 1, wanted) - cumulative.begin();
        vpls.push_back(make_vpl(points.on_front(static_cast<uint>(at), random), 1));
    }
    return vpls;
}

struct Tile {
    int x = 0;
    int y = 0;
};

std::vector<Tile> tiles_in_morton_order(int width, int height) {
    std::vector<Tile> tiles;
    for (int y = 0; y < height; y += NEARLIGHT_TILE_SIZE) {
        for (int x = 0; x < width; x += NEARLIGHT_TILE_SIZE) {
            tiles.push_back({x, y});
        }
    }
    const auto code = [](const Tile& tile) {
        return spread_bits(static_cast<uint>(tile.x / NEARLIGHT_TILE_SIZE)) |
               (spread_bits(static_cast<uint>(tile.y / NEARLIGHT_TILE_SIZE)) << 1u);
    };
    std::stable_sort(tiles.begin(), tiles.end(),
                     [&](const Tile& a, const Tile& b) { return code(a) < code(b); });
    return tiles;
}

}  // namespace

std::vector<ReceiverPacket> make_camera_receivers(const Scene& scene, const Bvh& bvh, int width, int height) {
    const PointMaker points(scene);
    const Camera camera = make_camera(scene.camera, width, height);
    std::vector<ReceiverPacket> packets;
    for (const Tile& tile : tiles_in_morton_order(width, height)) {
        ReceiverPacket& packet = packets.emplace_back();
        for (int i = 0; i < NEARLIGHT_PACKET_SIZE; ++i) {
            const int x = tile.x + i % NEARLIGHT_TILE_SIZE;
            const int y = tile.y + i / NEARLIGHT_TILE_SIZE;
            const RayQuery ray = pixel_ray(camera, static_cast<uint>(x), static_cast<uint>(y));
            const BvhHit hit = closest_hit(bvh, ray.origin, ray.direction, ray.t_min, ray.t_max);
            if (x >= width || y >= height || hit.triangle == ~0u) {
                continue;
            }
            set_receiver(packet, static_cast<std::size_t>(i), points.at_hit(hit, ray.direction));
        }
    }
    return packets;
}

std::vector<Vpl> make_traced_vpls(const Scene& scene, const Bvh& bvh, std::size_t count, std::uint64_t seed) {
    Pcg32 random(seed);
    std::vector<Vpl> vpls = trace_walks(scene, bvh, count, random);
    if (vpls.empty()) {
        vpls = spread_over_surfaces(scene, count, random);
    }
    sort_along_morton_curve(scene, vpls);
    return vpls;
}

std::vector<RayQuery> make_camera_rays(const Scene& scene, int width, int height) {
    const Camera camera = make_camera(scene.camera, width, height);
    std::vector<RayQuery> rays;
    for (const Tile& tile : tiles_in_morton_order(width, height)) {
        for (int i = 0; i < NEARLIGHT_PACKET_SIZE; ++i) {
            const int x = tile.x + i % NEARLIGHT_TILE_SIZE;
            const int y = tile.y + i / NEARLIGHT_TILE_SIZE;
            if (x < width && y < height) {
                rays.push_back(pixel_ray(camera, static_cast<uint>(x), static_cast<uint>(y)));
            }
        }
    }
    return rays;
}

std::vector<RayQuery> make_walk_rays(const Scene& scene, const Bvh& bvh, std::size_t count,
                                     std::uint64_t seed) {
    Pcg32 random(seed);
    std::vector<RayQuery> rays;
    follow_walks(scene, bvh, count, random, [&](const RayQuery& ray, const Vpl*) {
        rays.push_back(ray);
        return rays.size() < count;
    });
    if (rays.empty()) {
        for (const Vpl& vpl : spread_over_surfaces(scene, count, random)) {
            rays.push_back(endless_ray(vpl.position, cosine_direction(vpl.normal, random)));
        }
    }
    return rays;
}

void sort_along_morton_curve(const Scene& scene, std::vector<Vpl>& vpls) {
    const Aabb box = bounds(scene);
    const float scale = 1.0f / std::max(1e-30f, max_component(box.size()));
    std::stable_sort(vpls.begin(), vpls.end(), [&](const Vpl& a, const Vpl& b) {
        return morton_code((a.position - box.min) * scale) < morton_code((b.position - box.min) * scale);
    });
}

}  // namespace nearlight::core
