// SPDX-License-Identifier: Apache-2.0
// Trees with cut triangles are sound and, where expected, cheaper, and no ray passes between the parts.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "host/base/math.h"
#include "host/bvh/child_order.h"
#include "host/bvh/flatten.h"
#include "tests/bvh/soup.h"

namespace nearlight::core {
namespace {

using test::add_triangle;
using test::all_ids;
using test::build_all;
using test::random_point;
using test::random_soup;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr BvhConfig kQuality{.quality = BvhQuality::quality};

void expect_sound_and_small(const Scene& scene, const BvhConfig& config = kQuality) {
    const Bvh bvh = build_all(scene, config);
    EXPECT_THAT(check_bvh(bvh, scene, all_ids(scene)), IsEmpty());
    EXPECT_LE(static_cast<float>(bvh.triangles.size()),
              1.0f + static_cast<float>(scene.triangles.size()) * (1.0f + config.max_duplication));
}

/// Two slanting triangles that fill a wall in front of many specks.
Scene huge_and_tiny() {
    Scene scene = random_soup(3000, 0.02f, 31);
    add_triangle(scene, {-6, -6, -6}, {6, -6, 5}, {6, 6, 6});
    add_triangle(scene, {-6, -6, -6}, {6, 6, 6}, {-6, 6, -5});
    return scene;
}

TEST(BvhQuality, SmallCounts) {
    for (const int count : {0, 1, 2, 3, 5, 17, 40}) {
        SCOPED_TRACE(count);
        expect_sound_and_small(random_soup(count, 4.0f, 3));
    }
}

TEST(BvhQuality, SoupsAndLeafSizes) {
    for (const uint leaf_size : {1u, 4u, 16u}) {
        SCOPED_TRACE(leaf_size);
        expect_sound_and_small(random_soup(2000, 3.0f, leaf_size),
                               {.quality = BvhQuality::quality, .max_leaf_triangles = leaf_size});
    }
}

TEST(BvhQuality, AnyAllowanceForCutTriangles) {
    const Scene scene = test::diagonals(500, 5);
    for (const float duplication : {-1.0f, 0.0f, 0.01f, 0.5f, 2.0f}) {
        SCOPED_TRACE(duplication);
        const Bvh bvh = build_all(scene, {.quality = BvhQuality::quality, .max_duplication = duplication});
        EXPECT_THAT(check_bvh(bvh, scene, all_ids(scene)), IsEmpty());
        EXPECT_LE(static_cast<double>(bvh.triangles.size()),
                  500.0 * (1.0 + std::max(0.0, static_cast<double>(duplication))));
    }
}

TEST(BvhQuality, DegenerateHugeAndCoincidentTriangles) {
    Scene scene = random_soup(300, 2.0f, 6);
    for (int i = 0; i < 20; ++i) {
        const auto x = static_cast<float>(i);
        add_triangle(scene, {x, 0, 0}, {x, 0, 0}, {x, 0, 0});            // a point
        add_triangle(scene, {x, 0, 0}, {x, 1, 3}, {x, 2, 6});            // a line
        add_triangle(scene, {0, 0, 0}, {1e-42f, 0, 0}, {0, 1e-42f, 0});  // denormal
        add_triangle(scene, {0, 0, 0}, {3, 1, 2}, {1, 5, 0});            // 20 times the same
    }
    expect_sound_and_small(scene);
    add_triangle(scene, {-1e12f, 0, -1e12f}, {1e12f, 1, -1e12f}, {0, 2, 1e12f});
    expect_sound_and_small(scene);
    add_triangle(scene, {-3e38f, 0, 0}, {3e38f, 1, 0}, {0, 3e38f, 0});
    expect_sound_and_small(scene);
}

TEST(BvhQuality, CutsPayForLongDiagonals) {
    const Scene scene = test::diagonals(2000, 7);
    const Bvh fast = build_all(scene);
    const Bvh quality = build_all(scene, {.quality = BvhQuality::quality, .max_duplication = 1.0f});
    EXPECT_GT(quality.triangles.size(), scene.triangles.size());
    EXPECT_LT(quality.sah_cost, 0.8 * fast.sah_cost);
}

TEST(BvhQuality, NothingIsCutWhereNothingOverlaps) {
    const Scene scene = test::aligned_squares(8);
    EXPECT_EQ(build_all(scene, kQuality).triangles.size(), scene.triangles.size());
}

/// Checks that both trees find the same distances, which the same code computes.
void expect_same_hits(const Scene& scene, std::uint64_t seed) {
    const Bvh fast = build_all(scene);
    const Bvh quality = build_all(scene, {.quality = BvhQuality::quality, .max_duplication = 1.0f});
    Pcg32 random(seed);
    int hits = 0;
    for (int i = 0; i < 20000; ++i) {
        const Vec3 origin = random_point(random, 16.0f);
        // Every other ray aims at a point on a triangle.
        const auto at =
            static_cast<std::size_t>(random.uniform() * static_cast<float>(scene.triangles.size()));
        const Triangle& triangle = scene.triangles[std::min(at, scene.triangles.size() - 1)];
        const float u = random.uniform();
        const float v = random.uniform() * (1.0f - u);
        const Vec3 target = scene.vertices[triangle.v0].position * (1.0f - u - v) +
                            scene.vertices[triangle.v1].position * u +
                            scene.vertices[triangle.v2].position * v;
        const Vec3 direction = i % 2 == 0 ? target - origin : random_point(random, 2.0f);
        const float t_max = i % 3 == 0 ? 0.99f : kInfinity;
        const BvhHit expected = closest_hit(fast, origin, direction, 0.0f, t_max);
        ASSERT_EQ(closest_hit(quality, origin, direction, 0.0f, t_max).t, expected.t) << "ray " << i;
        ASSERT_EQ(occluded(quality, origin, direction, 0.0f, t_max), expected.triangle != ~0u) << "ray " << i;
        hits += expected.triangle != ~0u ? 1 : 0;
    }
    EXPECT_GT(hits, 4000);
}

TEST(BvhQuality, HitsAreThoseOfTheFastTree) {
    expect_same_hits(test::diagonals(1000, 8), 41);
    expect_same_hits(random_soup(1000, 3.0f, 9), 42);
    expect_same_hits(huge_and_tiny(), 43);
    expect_same_hits(test::aligned_squares(6), 44);
}

TEST(BvhQuality, ThreadsDoNotChangeTheResult) {
    Scene scene = random_soup(100000, 0.1f, 10);
    for (std::size_t i = 0; i < scene.vertices.size(); i += 50) {
        scene.vertices[i].position *= 0.5f;  // makes triangles long
    }
    const auto build_with = [&](std::size_t threads) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        return build_all(scene, kQuality);
    };
    const Bvh one = build_with(1);
    EXPECT_GT(one.triangles.size(), scene.triangles.size());
    for (int repeat = 0; repeat < 2; ++repeat) {
        const Bvh four = build_with(4);
        EXPECT_TRUE(test::same_bits(one.nodes, four.nodes));
        EXPECT_EQ(one.triangle_ids, four.triangle_ids);
    }
}

TEST(BvhQuality, CheckSeesALostPart) {
    const Scene scene = test::diagonals(200, 11);
    Bvh bvh = build_all(scene, {.quality = BvhQuality::quality, .max_duplication = 4.0f});
    const std::vector<uint> ids = distinct_triangles(bvh);
    EXPECT_EQ(ids, all_ids(scene));
    const auto entries = [&](uint id) {
        return std::count(bvh.triangle_ids.begin(), bvh.triangle_ids.end(), id);
    };
    const auto lost = std::find_if(ids.begin(), ids.end(), [&](uint id) { return entries(id) >= 3; });
    ASSERT_NE(lost, ids.end());
    const auto at = static_cast<std::size_t>(
        std::find(bvh.triangle_ids.begin(), bvh.triangle_ids.end(), *lost) - bvh.triangle_ids.begin());
    const std::size_t other = at == 0 ? 1 : at - 1;
    bvh.triangle_ids[at] = bvh.triangle_ids[other];
    bvh.triangles[at] = bvh.triangles[other];
    EXPECT_THAT(check_bvh(bvh, scene, ids), Contains(HasSubstr("leave a hole")));
}

TEST(ChildOrder, KeepsTheTreeSoundAndIsTheSameEachTime) {
    const Scene scene = random_soup(3000, 0.5f, 12);
    Bvh bvh = build_all(scene);
    const double cost = bvh.sah_cost;
    Bvh again = bvh;
    order_children(bvh, scene, all_ids(scene));
    order_children(again, scene, all_ids(scene));
    EXPECT_TRUE(test::same_bits(bvh.nodes, again.nodes));
    EXPECT_THAT(check_bvh(bvh, scene, all_ids(scene)), IsEmpty());
    EXPECT_NEAR(sah_cost(bvh, {}), cost, 1e-9 * cost);
}

// Segments between two walls. A screen stops those on one side; specks on the other side stop none.
TEST(ChildOrder, WhatOccludesComesFirst) {
    for (const float side : {-1.0f, 1.0f}) {
        SCOPED_TRACE(side);
        Scene scene = test::scene_of_one_material();
        add_triangle(scene, {-4, -5, -5}, {-4, 5, -5}, {-4, 0, 5});  // faces +x
        add_triangle(scene, {4, -5, -5}, {4, 0, 5}, {4, 5, -5});     // faces −x
        add_triangle(scene, {0, side * 0.2f, -4}, {0, side * 5, -4}, {0, side * 2, 4});
        add_triangle(scene, {0, side * 0.3f, -4}, {0, side * 5, -4}, {0, side * 2, 4});
        for (int i = 0; i < 20; ++i) {
            const float y = -side * (1.0f + 0.1f * static_cast<float>(i));
            add_triangle(scene, {0, y, 0}, {0, y + 0.01f, 0}, {0, y, 0.01f});
        }
        const std::vector<uint> ids = all_ids(scene);
        const std::span<const uint> walls = std::span(ids).first(2);
        Bvh bvh = build_bvh(scene, std::span(ids).subspan(2));
        order_children(bvh, scene, walls);
        const BvhNode& root = bvh.nodes.front();
        EXPECT_GT(side * (root.left_min.y + root.left_max.y), 0.0f);
    }
}

}  // namespace
}  // namespace nearlight::core
