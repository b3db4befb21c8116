// SPDX-License-Identifier: Apache-2.0
// Reinsertion finds better places for large boxes. The tree stays sound and never becomes too deep.
#include "host/bvh/reinsertion.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <utility>

#include "host/bvh/flatten.h"
#include "tests/bvh/soup.h"

namespace nearlight::core {
namespace {

using test::add_triangle;
using test::all_ids;
using test::random_soup;
using testing::IsEmpty;

struct BeforeAndAfter {
    Bvh before;
    Bvh after;
};

BeforeAndAfter reinsert(const Scene& scene) {
    const std::vector<uint> ids = all_ids(scene);
    Bvh before = flatten(build_sah_tree(scene, ids, {}), scene, {});
    SahTree tree = build_sah_tree(scene, ids, {});
    reinsert_largest(tree);
    return {std::move(before), flatten(std::move(tree), scene, {})};
}

/// Specks throughout a room, and its walls. Each wall is a rectangle of two triangles at a distance of 6.
Scene room() {
    Scene scene = random_soup(20000, 0.05f, 21);
    for (const float side : {-6.0f, 6.0f}) {
        for (int axis = 0; axis < 3; ++axis) {
            const auto corner = [&](float u, float v) {
                Vec3 p{};
                (&p.x)[axis] = side;
                (&p.x)[(axis + 1) % 3] = u;
                (&p.x)[(axis + 2) % 3] = v;
                return p;
            };
            add_triangle(scene, corner(-6, -6), corner(6, -6), corner(6, 6));
            add_triangle(scene, corner(-6, -6), corner(6, 6), corner(-6, 6));
        }
    }
    return scene;
}

TEST(Reinsertion, TakesWallsAwayFromWhatStandsBeforeThem) {
    const auto [before, after] = reinsert(room());
    EXPECT_LT(after.sah_cost, 0.95 * before.sah_cost);
}

TEST(Reinsertion, KeepsTreesSoundAndNeverMakesThemDearer) {
    for (const int count : {1, 2, 3, 4, 5, 6, 17, 3000}) {
        SCOPED_TRACE(count);
        const Scene scene = random_soup(count, 3.0f, 22);
        const auto [before, after] = reinsert(scene);
        EXPECT_THAT(check_bvh(after, scene, all_ids(scene)), IsEmpty());
        EXPECT_LE(after.sah_cost, before.sah_cost * (1.0 + 1e-6));
        EXPECT_EQ(after.nodes.size(), before.nodes.size());
    }
    EXPECT_THAT(check_bvh(reinsert(room()).after, room(), all_ids(room())), IsEmpty());
}

TEST(Reinsertion, LeavesHugeAndFlatScenesAlone) {
    Scene huge = random_soup(100, 1.0f, 23);
    add_triangle(huge, {-3e38f, 0, 0}, {3e38f, 1, 0}, {0, 3e38f, 0});
    Scene points = test::scene_of_one_material();
    for (int i = 0; i < 100; ++i) {
        add_triangle(points, {0, 0, 0}, {0, 0, 0}, {0, 0, 0});
    }
    for (const Scene& scene : {huge, points}) {
        const auto [before, after] = reinsert(scene);
        EXPECT_TRUE(test::same_bits(before.nodes, after.nodes));
    }
}

/// A tree with one leaf per level, each smaller than the one above. The lowest leaf is far away and belongs
/// at the top, where it would push the others down by a level.
SahTree chain(int depth) {
    SahTree tree;
    const auto box = [](int i) {
        const float size = 100.0f - static_cast<float>(i);
        return Aabb{{0, 0, 0}, {size, size, size}};
    };
    const Aabb far{{-300, 0, 0}, {-299, 100, 100}};
    tree.slots.resize(static_cast<std::size_t>(depth));
    tree.order.resize(static_cast<std::size_t>(depth) + 1);
    std::iota(tree.order.begin(), tree.order.end(), 0u);
    for (int i = 0; i < depth; ++i) {
        const auto index = static_cast<uint>(i);
        const bool last = i + 1 == depth;
        Aabb below = far;
        if (!last) {
            below.extend(box(i + 1));
        }
        const uint right = last ? leaf_reference(index + 1, 1) : index + 1;
        tree.slots[index] = {box(i).min, leaf_reference(index, 1), box(i).max, right, below.min, 0, below.max,
                             0};
    }
    tree.root_box = box(0);
    tree.root_box.extend(far);
    tree.inner_count = static_cast<std::size_t>(depth);
    tree.depth = depth;
    return tree;
}

TEST(Reinsertion, KeepsToTheGreatestDepth) {
    const auto changes = [](int depth) {
        SahTree tree = chain(depth);
        reinsert_largest(tree);
        EXPECT_LE(tree.depth, NEARLIGHT_MAX_BVH_DEPTH);
        return std::memcmp(tree.slots.data(), chain(depth).slots.data(),
                           tree.slots.size() * sizeof(BvhNode)) != 0;
    };
    EXPECT_TRUE(changes(20));
    EXPECT_TRUE(changes(NEARLIGHT_MAX_BVH_DEPTH - 1));
    EXPECT_FALSE(changes(NEARLIGHT_MAX_BVH_DEPTH));
}

}  // namespace
}  // namespace nearlight::core
