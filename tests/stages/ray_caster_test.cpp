// SPDX-License-Identifier: Apache-2.0
// Compares the kernels' traversal with a loop over all triangles in double precision, the host's traversal
// and Embree.
#include "host/stages/ray_caster.h"
#include "host/base/math.h"

#include <cmath>
#include <iostream>
#include <limits>
#include <memory>
#include <numeric>

#include "host/reference/ray_comparison.h"
#include "host/reference/test_rays.h"
#include "tests/support/device_fixture.h"
#include "tests/support/small_scenes.h"

namespace nearlight::core {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr std::size_t kTriangles = 600;
constexpr std::size_t kRays = 3000;

class RayCasterTest : public test::DeviceTest {};

Bvh build_all(const Scene& scene) {
    std::vector<uint> ids(scene.triangles.size());
    std::iota(ids.begin(), ids.end(), 0u);
    return build_bvh(scene, ids);
}

/// The same device, with one or the other tree for single rays.
std::unique_ptr<Device> with_ray_tree(const Device& device, bool wide) {
    DeviceOptions options = device.options();
    options.wide_rays = wide;
    return std::make_unique<Device>(device.entry(), options);
}

/// Number of hits of the same triangle whose values differ in their bits.
std::size_t count_different_bits(const std::vector<BvhHit>& a, const std::vector<BvhHit>& b) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const bool same = a[i].t == b[i].t && a[i].u == b[i].u && a[i].v == b[i].v;
        count += a[i].triangle == b[i].triangle && !same ? 1 : 0;
    }
    return count;
}

std::vector<RayQuery> normalised(std::vector<RayQuery> rays) {
    for (RayQuery& ray : rays) {
        ray.direction = normalize(ray.direction);
    }
    return rays;
}

/// Checks that each dispute is a tie, and that ties are rare unless the rays seek edges. Every dispute is
/// printed.
void expect_agreement(const std::string& oracle, const Scene& scene, const RayFamily& family,
                      const std::vector<BvhHit>& expected, const std::vector<BvhHit>& found) {
    SCOPED_TRACE(family.name + " rays against " + oracle);
    const RayComparison comparison = compare_hits(scene, family.rays, expected, found);
    for (const RayDispute& dispute : comparison.disputes) {
        std::cout << family.name << ", " << oracle << ": " << to_string(dispute) << '\n';
        EXPECT_TRUE(dispute.excused) << to_string(dispute);
    }
    EXPECT_GT(comparison.hits, comparison.rays / 10);
    EXPECT_LE(comparison.disputes.size(), family.meets_edges ? comparison.rays / 2 : comparison.rays / 500);
}

TEST_F(RayCasterTest, ClosestHitsAgreeWithBruteForceHostAndEmbree) {
    const Scene scene = make_triangle_soup(kTriangles, 11);
    const Bvh bvh = build_all(scene);
    for (const RayFamily& family : make_ray_families(scene, kRays, 12)) {
        const std::vector<BvhHit> brute_force = brute_force_hits(scene, family.rays);
        const std::vector<BvhHit> host = host_hits(bvh, family.rays);
        const std::vector<BvhHit> embree = embree_hits(scene, family.rays);
        on_each_ray_tree([&](Device& device) {
            const std::vector<BvhHit> found = RayCaster(device).closest_hits(bvh, family.rays);
            expect_agreement("brute force", scene, family, brute_force, found);
            expect_agreement("host tree", scene, family, host, found);
            expect_agreement("Embree", scene, family, embree, found);
        });
    }
}

TEST_F(RayCasterTest, AnyHitIsWhetherThereIsAClosestHit) {
    const Scene scene = make_triangle_soup(kTriangles, 13);
    const Bvh bvh = build_all(scene);
    on_each_ray_tree([&](Device& device) {
        RayCaster caster(device);
        for (const RayFamily& family : make_ray_families(scene, kRays, 14)) {
            const std::vector<BvhHit> closest = caster.closest_hits(bvh, family.rays);
            const std::vector<uint> any = caster.any_hits(bvh, family.rays);
            std::size_t hits = 0;
            for (std::size_t i = 0; i < any.size(); ++i) {
                ASSERT_EQ(any[i] != 0, closest[i].triangle != ~0u) << family.name << " ray " << i;
                hits += any[i];
            }
            EXPECT_GT(hits, any.size() / 10);
        }
    });
}

/// Where the direction is 0 across a face of a box and the ray runs in that face, 0 · ∞ is no number.
TEST_F(RayCasterTest, RaysInTheFacesOfBoxesMeetTheEdgesThere) {
    Scene scene;
    const uint grey = small_scenes::add_material(scene, small_scenes::lambertian({0.5f, 0.5f, 0.5f}));
    std::vector<RayQuery> rays;
    for (int i = -20; i < 20; ++i) {
        const float x = 3.0f * static_cast<float>(i);
        small_scenes::add_quad(scene, {x, 0, 5}, {1, 0, 0}, {0, 1, 0}, grey);
        for (const float zero : {0.0f, -0.0f}) {
            rays.push_back({{x, 0.25f, 0}, 0.0f, {zero, zero, 1}, kInfinity});
            rays.push_back({{x + 1, 0.25f, 0}, 0.0f, {zero, zero, 1}, kInfinity});
            rays.push_back({{x + 0.25f, 0, 10}, 0.0f, {zero, zero, -1}, kInfinity});
            rays.push_back({{x + 0.25f, 1, 10}, 0.0f, {zero, zero, -1}, kInfinity});
        }
    }
    const Bvh bvh = build_all(scene);
    on_each_ray_tree([&](Device& device) {
        for (const BvhHit& hit : RayCaster(device).closest_hits(bvh, rays)) {
            EXPECT_EQ(hit.t, 5.0f);
        }
        EXPECT_EQ(RayCaster(device).any_hits(bvh, rays), std::vector<uint>(rays.size(), 1));
    });
}

TEST_F(RayCasterTest, BrokenRaysHitNothing) {
    const Scene scene = make_triangle_soup(kTriangles, 15);
    const Bvh bvh = build_all(scene);
    const std::vector<RayQuery> rays = make_broken_rays();
    on_each_ray_tree([&](Device& device) {
        RayCaster caster(device);
        const std::vector<BvhHit> closest = caster.closest_hits(bvh, rays);
        const std::vector<uint> any = caster.any_hits(bvh, rays);
        for (std::size_t i = 0; i < rays.size(); ++i) {
            EXPECT_EQ(closest[i].triangle, ~0u) << "ray " << i;
            EXPECT_EQ(any[i], 0u) << "ray " << i;
        }
    });
}

/// A NaN in triangles of a tree removes those triangles, and no others.
TEST_F(RayCasterTest, BrokenTrianglesAreNeverHit) {
    const Scene scene = make_triangle_soup(kTriangles, 16);
    Bvh bvh = build_all(scene);
    for (std::size_t i = 0; i < bvh.triangles.size(); i += 3) {
        BvhTriangle& triangle = bvh.triangles[i];
        const float broken = i % 4 < 2 ? kNaN : kInfinity;
        if (i % 2 == 0) {
            triangle.edge1.x = triangle.normal.y = triangle.normal.z = broken;  // made of one another
        } else {
            triangle.v0.y = broken;
        }
    }
    const RayFamily family = make_ray_families(scene, kRays, 17).front();
    const std::vector<BvhHit> expected = host_hits(bvh, family.rays);
    on_each_ray_tree([&](Device& device) {
        const std::vector<BvhHit> found = RayCaster(device).closest_hits(bvh, family.rays);
        for (std::size_t i = 0; i < found.size(); ++i) {
            if (found[i].triangle != ~0u) {
                const auto slot =
                    std::find(bvh.triangle_ids.begin(), bvh.triangle_ids.end(), found[i].triangle);
                ASSERT_NE((slot - bvh.triangle_ids.begin()) % 3, 0) << "ray " << i;
            }
        }
        EXPECT_EQ(compare_hits(scene, family.rays, expected, found).mismatches(), 0u);
    });
}

/// The answers of the two trees are rounded alike, so they may differ only in ties.
TEST_F(RayCasterTest, WideAndBinaryTreesGiveTheSameHits) {
    const Scene scene = make_triangle_soup(20 * kTriangles, 20);
    std::vector<uint> ids(scene.triangles.size());
    std::iota(ids.begin(), ids.end(), 0u);
    for (const BvhQuality quality : {BvhQuality::fast, BvhQuality::quality}) {
        const Bvh bvh = build_bvh(scene, ids, {.quality = quality});
        on_each_device([&](Device& device) {
            const std::unique_ptr<Device> wide = with_ray_tree(device, true);
            const std::unique_ptr<Device> binary = with_ray_tree(device, false);
            for (const RayFamily& family : make_ray_families(scene, kRays, 21)) {
                const std::vector<BvhHit> expected = RayCaster(*binary).closest_hits(bvh, family.rays);
                const std::vector<BvhHit> found = RayCaster(*wide).closest_hits(bvh, family.rays);
                expect_agreement("the binary tree", scene, family, expected, found);
                EXPECT_LE(count_different_bits(expected, found), device.is_cpu() ? 0u : found.size());
            }
        });
    }
}

/// Directions with components that are zero, tiny or huge, of both signs, and infinite intervals. They make
/// reciprocals zero, infinite or NaN in careless code.
TEST_F(RayCasterTest, ExtremeDirectionsAreNoTrouble) {
    const Scene scene = make_triangle_soup(kTriangles, 22);
    const Bvh bvh = build_all(scene);
    const std::vector<float> parts{0.0f, -0.0f, 1e-38f, -1e-38f, 1e-25f, 1.0f, -1.0f, 1e25f, 1e38f, -1e38f};
    std::vector<RayQuery> rays;
    for (const float x : parts) {
        for (const float y : parts) {
            for (const float z : parts) {
                rays.push_back({{0.1f, -0.2f, 0.3f}, 0.0f, {x, y, z}, kInfinity});
            }
        }
    }
    on_each_ray_tree([&](Device& device) {
        const std::vector<BvhHit> closest = RayCaster(device).closest_hits(bvh, rays);
        const std::vector<uint> any = RayCaster(device).any_hits(bvh, rays);
        const std::vector<BvhHit> unit = RayCaster(device).closest_hits(bvh, normalised(rays));
        for (std::size_t i = 0; i < rays.size(); ++i) {
            EXPECT_EQ(any[i] != 0, closest[i].triangle != ~0u) << "ray " << i;
            const Vec3 d = rays[i].direction;
            // Products of three huge or three tiny numbers leave the range of single precision.
            if (const float square = dot(d, d); square > 1e-9f && square < 1e9f) {
                EXPECT_EQ(closest[i].triangle, unit[i].triangle) << "ray " << i;
            }
        }
    });
}

TEST_F(RayCasterTest, TheEndsOfTheIntervalAreExcluded) {
    Scene scene;
    scene.materials.push_back({});
    for (const Vec3 p : {Vec3{0, 0, 0}, Vec3{4, 0, 0}, Vec3{0, 4, 0}}) {
        scene.vertices.push_back({.position = p, .u = 0, .normal = {0, 0, 0}, .v = 0});
    }
    scene.triangles.push_back({0, 1, 2, 0});
    const Bvh bvh = build_all(scene);
    const auto ray = [](float t_min, float t_max) { return RayQuery{{1, 1, 1}, t_min, {0, 0, -1}, t_max}; };
    const std::vector<RayQuery> rays{ray(0.5f, 1.5f), ray(1, 2), ray(0, 1),
                                     ray(std::nextafter(1.0f, 0.0f), std::nextafter(1.0f, 2.0f))};
    on_each_ray_tree([&](Device& device) {
        EXPECT_EQ(RayCaster(device).any_hits(bvh, rays), (std::vector<uint>{1, 0, 0, 1}));
        const BvhHit hit = RayCaster(device).closest_hits(bvh, rays)[0];
        EXPECT_EQ(hit.t, 1.0f);
        EXPECT_EQ(hit.u, 0.25f);
        EXPECT_EQ(hit.v, 0.25f);
    });
}

TEST_F(RayCasterTest, NoRaysAndNoTriangles) {
    on_each_ray_tree([](Device& device) {
        RayCaster caster(device);
        const Bvh empty = build_all(Scene{});
        EXPECT_TRUE(caster.closest_hits(empty, {}).empty());
        EXPECT_EQ(caster.any_hits(empty, std::vector<RayQuery>{{{0, 0, 0}, 0.0f, {1, 1, 1}, kInfinity}})[0],
                  0u);
    });
}

/// Tests the comparison itself, which must find planted faults.
TEST(RayComparison, WrongAnswersAreNoTies) {
    const Scene scene = make_triangle_soup(kTriangles, 18);
    const RayFamily family = make_ray_families(scene, 500, 19).front();
    const std::vector<BvhHit> right = brute_force_hits(scene, family.rays);
    EXPECT_TRUE(compare_hits(scene, family.rays, right, right).disputes.empty());
    const auto hit = static_cast<std::size_t>(
        std::find_if(right.begin(), right.end(), [](const BvhHit& h) { return h.triangle != ~0u; }) -
        right.begin());
    std::vector<BvhHit> missed = right;
    missed[hit] = {};
    EXPECT_EQ(compare_hits(scene, family.rays, right, missed).mismatches(), 1u);
    std::vector<BvhHit> too_far = right;
    too_far[hit].t *= 1.001f;
    EXPECT_EQ(compare_hits(scene, family.rays, right, too_far).mismatches(), 1u);
}

}  // namespace
}  // namespace nearlight::core
