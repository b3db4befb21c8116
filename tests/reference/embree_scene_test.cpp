// SPDX-License-Identifier: Apache-2.0
#include "host/reference/embree_scene.h"
#include "host/base/math.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>
#include <sstream>

#include "host/reference/brute_force.h"
#include "host/reference/test_rays.h"
#include "tests/support/small_scenes.h"

namespace nearlight::core {
namespace {

using namespace small_scenes;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

Scene make_soup() {
    return make_triangle_soup(1000, 11);
}

std::vector<RayQuery> rays_of_family(const Scene& scene, const std::string& name, std::size_t count) {
    const std::vector<RayFamily> families = make_ray_families(scene, count, 12);
    return std::ranges::find(families, name, &RayFamily::name)->rays;
}

/// Minimum distance between the line o + t·d and the segment a b, by ternary search, because the distance is
/// convex along b − a.
double line_to_segment(Vec3 o, Vec3 d, Vec3 a, Vec3 b) {
    const Vec3 unit = normalize(d);
    const auto distance = [&](double s) {
        const Vec3 p = a + (b - a) * static_cast<float>(s) - o;
        return double(length(cross(p, unit)));
    };
    double low = 0;
    double high = 1;
    for (int i = 0; i < 60; ++i) {
        const double third = (high - low) / 3;
        (distance(low + third) < distance(high - third) ? high : low) +=
            distance(low + third) < distance(high - third) ? -third : third;
    }
    return distance(0.5 * (low + high));
}

/// Whether the ray passes so near an edge that single precision may decide either way. A ray in the
/// triangle's plane crosses its edges, and a triangle without area is all edge.
bool touches_edge(const Scene& scene, const Triangle& triangle, const RayQuery& ray) {
    const Vec3 a = scene.vertices[triangle.v0].position;
    const Vec3 b = scene.vertices[triangle.v1].position;
    const Vec3 c = scene.vertices[triangle.v2].position;
    constexpr double kEdge = 2e-6;
    return line_to_segment(ray.origin, ray.direction, a, b) < kEdge ||
           line_to_segment(ray.origin, ray.direction, b, c) < kEdge ||
           line_to_segment(ray.origin, ray.direction, c, a) < kEdge;
}

std::string describe(const RayQuery& ray, const BvhHit& expected, const BvhHit& found) {
    std::ostringstream text;
    text << "ray (" << ray.origin.x << ", " << ray.origin.y << ", " << ray.origin.z << ") + t·("
         << ray.direction.x << ", " << ray.direction.y << ", " << ray.direction.z << "): expected triangle "
         << int(expected.triangle) << " at " << expected.t << ", found " << int(found.triangle) << " at "
         << found.t;
    return text.str();
}

double cosine_to(const Scene& scene, uint id, Vec3 direction) {
    const Triangle& t = scene.triangles[id];
    const Vec3 v0 = scene.vertices[t.v0].position;
    const Vec3 n = cross(scene.vertices[t.v1].position - v0, scene.vertices[t.v2].position - v0);
    return std::abs(dot(normalize(n), normalize(direction)));
}

/// Embree must agree with brute force, except where the ray touches the nearer of the two triangles at an
/// edge. Each such tie is printed.
void expect_agreement(const Scene& scene, const std::vector<RayQuery>& rays, double max_tie_fraction) {
    const EmbreeScene embree(scene);
    int ties = 0;
    int hits = 0;
    for (const RayQuery& ray : rays) {
        const BvhHit expected =
            brute_force_closest_hit(scene, {}, ray.origin, ray.direction, ray.t_min, ray.t_max);
        const BvhHit found = embree.closest_hit(ray.origin, ray.direction, ray.t_min, ray.t_max);
        ASSERT_EQ(embree.occluded(ray.origin, ray.direction, ray.t_min, ray.t_max), found.triangle != ~0u);
        hits += expected.triangle != ~0u ? 1 : 0;
        if (expected.triangle == ~0u && found.triangle == ~0u) {
            continue;
        }
        const double cosine =
            expected.triangle == found.triangle ? cosine_to(scene, found.triangle, ray.direction) : 0.0;
        if (cosine > 1e-4) {
            EXPECT_NEAR(found.t, expected.t, 2e-6 * (1 + expected.t) / cosine)
                << describe(ray, expected, found);
            continue;
        }
        ++ties;
        const BvhHit& nearer = found.t < expected.t ? found : expected;
        EXPECT_TRUE(touches_edge(scene, scene.triangles[nearer.triangle], ray))
            << describe(ray, expected, found);
        std::cout << "tie: " << describe(ray, expected, found) << '\n';
    }
    EXPECT_GT(hits, static_cast<int>(rays.size() / 10));
    EXPECT_LE(ties, max_tie_fraction * static_cast<double>(rays.size()));
}

TEST(EmbreeScene, AgreesWithBruteForceOnRandomRays) {
    const Scene scene = make_soup();
    expect_agreement(scene, rays_of_family(scene, "random", 8000), 0.001);
}

TEST(EmbreeScene, AgreesWithBruteForceOnAxisAlignedRays) {
    const Scene scene = make_soup();
    expect_agreement(scene, rays_of_family(scene, "axis-aligned", 4000), 0.002);
}

TEST(EmbreeScene, AgreesWithBruteForceOnGrazingRays) {
    const Scene scene = make_soup();
    expect_agreement(scene, rays_of_family(scene, "grazing", 4000), 0.5);
}

TEST(EmbreeScene, BrokenRaysAndTrianglesHitNothing) {
    Scene scene;
    const uint material = add_material(scene, lambertian({0.5f, 0.5f, 0.5f}));
    add_quad(scene, {-1, -1, 2}, {2, 0, 0}, {0, 2, 0}, material);
    add_triangle(scene, {-1, -1, 1}, {kNaN, 1, 1}, {1, 1, 1}, material);
    add_triangle(scene, {-1, -1, 1}, {-1, -1, 1}, {-1, -1, 1}, material);
    const EmbreeScene embree(scene);
    const BvhHit hit = embree.closest_hit({0.1f, 0.2f, 0}, {0, 0, 1}, 0, kInfinity);
    EXPECT_NEAR(hit.t, 2.0f, 1e-5f);
    EXPECT_LT(hit.triangle, 2u);
    EXPECT_EQ(brute_force_closest_hit(scene, {}, {0.1f, 0.2f, 0}, {0, 0, 1}, 0, kInfinity).triangle,
              hit.triangle);
    const std::vector<std::pair<Vec3, Vec3>> broken{
        {{kNaN, 0, 0}, {0, 0, 1}}, {{0, 0, 0}, {0, kNaN, 1}}, {{0, 0, 0}, {0, 0, 0}}};
    for (const auto& [origin, direction] : broken) {
        EXPECT_EQ(embree.closest_hit(origin, direction, 0, kInfinity).triangle, ~0u);
        EXPECT_FALSE(embree.occluded(origin, direction, 0, kInfinity));
        EXPECT_FALSE(brute_force_occluded(scene, {}, origin, direction, 0, kInfinity));
    }
}

TEST(EmbreeScene, PacketsAgreeWithSingleRays) {
    const Scene scene = make_soup();
    const EmbreeScene embree(scene, {.quality = EmbreeOptions::Quality::high, .coherent = true});
    const std::vector<RayQuery> rays = rays_of_family(scene, "random", 1600);
    constexpr std::uint32_t kActive = 0xfff7u;  // lane 3 is idle
    for (std::size_t first = 0; first < rays.size(); first += 16) {
        Rays16 packet{};
        std::uint32_t expected = 0;
        for (std::size_t lane = 0; lane < 16; ++lane) {
            const Vec3 o = rays[first + lane].origin;
            const Vec3 d = rays[first + lane].direction;
            packet.origin_x[lane] = o.x;
            packet.origin_y[lane] = o.y;
            packet.origin_z[lane] = o.z;
            packet.direction_x[lane] = d.x;
            packet.direction_y[lane] = d.y;
            packet.direction_z[lane] = d.z;
            packet.t_max[lane] = 1.0f;
            expected |= (embree.occluded(o, d, 0.0f, 1.0f) ? 1u : 0u) << lane;
        }
        EXPECT_EQ(embree.occluded16(packet, kActive), expected & kActive);
    }
}

TEST(EmbreeScene, GlassIsASurfaceLikeOthers) {
    Scene scene;
    const uint glass = add_material(scene, thin_dielectric_material(1.5));
    add_quad(scene, {-1, -1, 1}, {2, 0, 0}, {0, 2, 0}, glass);
    add_quad(scene, {-1, -1, 2}, {2, 0, 0}, {0, 2, 0}, add_material(scene, lambertian({1, 1, 1})));
    const EmbreeScene embree(scene);
    EXPECT_LT(embree.closest_hit({0.1f, 0, 0}, {0, 0, 1}, 0, kInfinity).triangle, 2u);
    EXPECT_GE(embree.closest_hit({0.1f, 0, 1.1f}, {0, 0, 1}, 0, kInfinity).triangle, 2u);
    EXPECT_FALSE(embree.blocked({0.1f, 0, 0}, {0.1f, 0, 0.9f}));
    EXPECT_TRUE(embree.blocked({0.1f, 0, 0}, {0.1f, 0, 1.9f}));
}

TEST(EmbreeScene, AnEmptySceneHasNoHits) {
    const EmbreeScene embree(Scene{});
    EXPECT_EQ(embree.closest_hit({0, 0, 0}, {0, 0, 1}, 0, kInfinity).triangle, ~0u);
    EXPECT_FALSE(embree.occluded({0, 0, 0}, {0, 0, 1}, 0, kInfinity));
}

}  // namespace
}  // namespace nearlight::core
