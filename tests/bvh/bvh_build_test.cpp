// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <cstring>
#include <numeric>

#include "host/bvh/flatten.h"
#include "host/scene/material_model.h"
#include "tests/bvh/soup.h"

namespace nearlight::core {
namespace {

using test::add_triangle;
using test::all_ids;
using test::build_all;
using test::random_soup;
using testing::IsEmpty;

void expect_sound(const Scene& scene, const BvhConfig& config = {}) {
    EXPECT_THAT(check_bvh(build_all(scene, config), scene, all_ids(scene)), IsEmpty());
}

TEST(BvhBuild, SmallCounts) {
    for (const int count : {0, 1, 2, 3, 5, 17}) {
        SCOPED_TRACE(count);
        expect_sound(random_soup(count, 1.0f, 3));
    }
}

TEST(BvhBuild, RandomSoupsAndLeafSizes) {
    for (const uint leaf_size : {1u, 2u, 4u, 16u}) {
        SCOPED_TRACE(leaf_size);
        expect_sound(random_soup(3000, 0.5f, leaf_size), {.max_leaf_triangles = leaf_size});
    }
}

TEST(BvhBuild, ConfigurationOutOfRangeIsClamped) {
    expect_sound(random_soup(500, 0.5f, 1), {.bin_count = 0, .max_leaf_triangles = 0});
    expect_sound(random_soup(500, 0.5f, 1), {.bin_count = 1 << 20, .max_leaf_triangles = 1000});
}

TEST(BvhBuild, OnlyTheTrianglesThatWereNamed) {
    const Scene scene = random_soup(100, 0.5f, 4);
    const std::vector<uint> ids{99, 3, 50, 51, 52, 7, 8, 0};
    EXPECT_THAT(check_bvh(build_bvh(scene, ids), scene, ids), IsEmpty());
}

TEST(BvhBuild, ClustersAtVeryDifferentScales) {
    Scene scene = random_soup(1000, 1.0f, 5);
    for (std::size_t i = 0; i < scene.vertices.size(); i += 2) {
        scene.vertices[i].position *= 1e-5f;
    }
    expect_sound(scene);
}

TEST(BvhBuild, CoincidentCentroidsAreHalved) {
    Scene scene = test::scene_of_one_material();
    for (int i = 1; i <= 100; ++i) {
        const auto r = static_cast<float>(i);
        add_triangle(scene, {-r, -r, 0}, {r, -r, 0}, {0, r, 0});
    }
    expect_sound(scene);
    EXPECT_EQ(build_all(scene, {.max_leaf_triangles = 1}).depth, 7);
}

TEST(BvhBuild, SeventeenCoplanarDuplicates) {
    Scene scene = test::scene_of_one_material();
    for (int i = 0; i < 17; ++i) {
        add_triangle(scene, {0, 0, 0}, {1, 0, 0}, {0, 0, 1});
    }
    expect_sound(scene, {.max_leaf_triangles = 16});
    expect_sound(scene, {.max_leaf_triangles = 4});
}

TEST(BvhBuild, DegenerateAndHugeTriangles) {
    Scene scene = random_soup(300, 0.5f, 6);
    for (int i = 0; i < 20; ++i) {
        const auto x = static_cast<float>(i);
        add_triangle(scene, {x, 0, 0}, {x, 0, 0}, {x, 0, 0});            // a point
        add_triangle(scene, {x, 0, 0}, {x, 1, 0}, {x, 2, 0});            // a line
        add_triangle(scene, {0, 0, 0}, {1e-42f, 0, 0}, {0, 1e-42f, 0});  // denormal
        add_triangle(scene, {-3e38f, x, 0}, {3e38f, x, 0}, {0, 3e38f, 0});
        add_triangle(scene, {-1e20f, x, -1e20f}, {1e20f, x, -1e20f}, {0, x, 1e20f});
    }
    expect_sound(scene);
    EXPECT_TRUE(std::isfinite(build_all(scene).sah_cost));
}

// Each plane separates the largest triangle from all others, so that a tree built by cost alone would be a
// list.
TEST(BvhBuild, DepthIsBoundedOnAGeometricSeries) {
    Scene scene = test::scene_of_one_material();
    for (int copy = 0; copy < 20; ++copy) {
        for (int i = -60; i < 60; ++i) {
            const float x = std::ldexp(1.0f + static_cast<float>(copy) * 1e-3f, i);
            add_triangle(scene, {x, 0, 0}, {x, x * 0.01f, 0}, {x, 0, x * 0.01f});
        }
    }
    const Bvh bvh = build_all(scene, {.bin_count = 8, .max_leaf_triangles = 1});
    EXPECT_THAT(check_bvh(bvh, scene, all_ids(scene)), IsEmpty());
    EXPECT_GT(bvh.depth, 30);  // the series makes a deep tree
    EXPECT_LE(bvh.depth, NEARLIGHT_MAX_BVH_DEPTH);
}

TEST(BvhBuild, ALeftChildFollowsItsParent) {
    const Bvh bvh = build_all(random_soup(2000, 0.5f, 7));
    for (std::size_t i = 0; i < bvh.nodes.size(); ++i) {
        if ((bvh.nodes[i].left & NEARLIGHT_LEAF_BIT) == 0) {
            ASSERT_EQ(bvh.nodes[i].left, i + 1);
        }
    }
}

template <typename T>
bool same_bits(const std::vector<T>& a, const std::vector<T>& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

TEST(BvhBuild, ThreadsDoNotChangeTheResult) {
    Scene scene = random_soup(150000, 0.1f, 8);
    for (std::size_t i = 0; i < scene.vertices.size(); i += 5) {  // zeros of both signs
        scene.vertices[i].position.x = i % 2 == 0 ? 0.0f : -0.0f;
    }
    const auto build_with = [&](std::size_t threads) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        return build_all(scene);
    };
    const Bvh one = build_with(1);
    for (int repeat = 0; repeat < 3; ++repeat) {
        const Bvh four = build_with(4);
        EXPECT_TRUE(same_bits(one.nodes, four.nodes));
        EXPECT_TRUE(same_bits(one.triangles, four.triangles));
        EXPECT_EQ(one.triangle_ids, four.triangle_ids);
        EXPECT_EQ(one.sah_cost, four.sah_cost);
    }
}

TEST(BvhBuild, CostOfTwoSeparateTriangles) {
    Scene scene = test::scene_of_one_material();
    add_triangle(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    add_triangle(scene, {9, 0, 0}, {10, 0, 0}, {9, 1, 0});
    const BvhConfig config{.max_leaf_triangles = 4, .traversal_cost = 0.5f, .intersection_cost = 2.0f};
    const Bvh bvh = build_all(scene, config);
    // The half areas are 1 each in a box of 10, so a ray visits one node and tests each triangle with
    // probability 1/10.
    EXPECT_NEAR(bvh.sah_cost, 0.5 + 2 * 2.0 * 0.1, 1e-4);
}

/// Cost below a child, weighted by probability and summed from the leaves up. Half areas of boxes are in
/// units of the root's.
double cost_below(const Bvh& bvh, uint child, const Aabb& box, double root_area) {
    const double chance = box.half_area() / root_area;
    if (is_leaf(child)) {
        return chance * leaf_count(child);
    }
    const BvhNode& node = bvh.nodes[child];
    return chance + cost_below(bvh, node.left, {node.left_min, node.left_max}, root_area) +
           cost_below(bvh, node.right, {node.right_min, node.right_max}, root_area);
}

TEST(BvhBuild, CostAgreesWithAWalkOfTheTreeAndIsLow) {
    const Bvh bvh = build_all(random_soup(5000, 0.05f, 9));
    const BvhNode& root = bvh.nodes[0];
    Aabb box{root.left_min, root.left_max};
    box.extend({root.right_min, root.right_max});
    EXPECT_NEAR(bvh.sah_cost, cost_below(bvh, 0, box, box.half_area()), 1e-3 * bvh.sah_cost);
    EXPECT_LT(bvh.sah_cost, 40.0);  // a ray that meets 5000 scattered specks tests a few dozen boxes
}

TEST(BvhBuild, OneTreeHasTheSurfacesOfAllModels) {
    Scene scene = random_soup(60, 0.5f, 10);
    const Bvh diffuse = build_scene_bvh(scene);
    std::vector<uint> all(60);
    std::iota(all.begin(), all.end(), 0u);
    for (const uint model : {NEARLIGHT_BSDF_DIELECTRIC, NEARLIGHT_BSDF_THIN_DIELECTRIC,
                             NEARLIGHT_BSDF_CONDUCTOR, NEARLIGHT_BSDF_NULL, NEARLIGHT_BSDF_MASK}) {
        scene.materials.push_back(plain_material(model));
    }
    for (uint i = 0; i < 60; ++i) {
        scene.triangles[i].material = i % static_cast<uint>(scene.materials.size());
    }
    const Bvh bvh = build_scene_bvh(scene);
    EXPECT_THAT(check_bvh(bvh, scene, all), IsEmpty());
    EXPECT_EQ(bvh.triangle_ids, diffuse.triangle_ids) << "materials do not count";
}

}  // namespace
}  // namespace nearlight::core
