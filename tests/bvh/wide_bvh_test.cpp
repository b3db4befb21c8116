// SPDX-License-Identifier: Apache-2.0
#include "host/bvh/wide_bvh.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <functional>
#include <iterator>

#include "host/bvh/collapse_plan.h"
#include "tests/bvh/soup.h"

namespace nearlight::core {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;

TEST(WideBvh, HoldsTheBinaryTree) {
    for (const int count : {1, 2, 4, 5, 9, 37, 1000, 20000}) {
        SCOPED_TRACE(count);
        const Bvh bvh = test::build_all(test::random_soup(count, 0.5f, 3));
        EXPECT_THAT(check_wide_bvh(widen(bvh), bvh), IsEmpty());
    }
}

TEST(WideBvh, HoldsFlatBoxesAndFullLeaves) {
    const Bvh flat = test::build_all(test::aligned_squares(9));
    EXPECT_THAT(check_wide_bvh(widen(flat), flat), IsEmpty());
    // A leaf of sixteen triangles fills four blocks.
    const Bvh full = test::build_all(test::random_soup(3000, 5.0f, 4),
                                     {.max_leaf_triangles = 16, .traversal_cost = 100.0f});
    EXPECT_THAT(check_wide_bvh(widen(full), full), IsEmpty());
}

TEST(WideBvh, HoldsCutTriangles) {
    const Bvh bvh =
        test::build_all(test::diagonals(2000, 7), {.quality = BvhQuality::quality, .max_duplication = 1.0f});
    ASSERT_GT(bvh.triangles.size(), 2000u);
    EXPECT_THAT(check_wide_bvh(widen(bvh), bvh), IsEmpty());
}

TEST(WideBvh, SceneWithoutTriangles) {
    const Bvh bvh = build_bvh(test::scene_of_one_material(), {});
    EXPECT_THAT(check_wide_bvh(widen(bvh), bvh), IsEmpty());
}

TEST(WideBvh, NodesAndBlocksAreWellFilled) {
    const Bvh bvh = test::build_all(test::random_soup(20000, 0.2f, 5));
    const WideBvh wide = widen(bvh);
    EXPECT_LT(wide.nodes.size(), bvh.nodes.size() / 3);
    EXPECT_LT(wide.blocks.size(), bvh.triangles.size() / 2);
}

TEST(WideBvh, LargestChildIsLast) {
    const WideBvh wide = widen(test::build_all(test::random_soup(500, 0.2f, 6)));
    for (const WideNode& node : wide.nodes) {
        float before = 0.0f;
        for (std::size_t i = 0; i < NEARLIGHT_WIDE_CHILDREN && node.low[0][i] <= node.high[0][i]; ++i) {
            const Aabb box{{node.low[0][i], node.low[1][i], node.low[2][i]},
                           {node.high[0][i], node.high[1][i], node.high[2][i]}};
            EXPECT_GE(box.half_area(), before);
            before = box.half_area();
        }
    }
}

double surface(const WideNode& node, std::size_t i) {
    return Aabb{{node.low[0][i], node.low[1][i], node.low[2][i]},
                {node.high[0][i], node.high[1][i], node.high[2][i]}}
        .half_area();
}

/// Sum of the surface areas of all nodes below the root.
double surface_of_nodes(const WideBvh& wide) {
    double sum = 0.0;
    for (const WideNode& node : wide.nodes) {
        for (std::size_t i = 0; i < NEARLIGHT_WIDE_CHILDREN && node.low[0][i] <= node.high[0][i]; ++i) {
            sum += (node.child[i] & NEARLIGHT_LEAF_BIT) != 0 ? 0.0 : surface(node, i);
        }
    }
    return sum;
}

/// Sum of the surface areas of the nodes in the tree in which each node takes over its child of the largest
/// surface until it has eight children.
double greedy_surface(const Bvh& bvh, const CollapsePlan& plan, uint node) {
    const auto both = [&](uint of) {
        const BvhNode& n = bvh.nodes[of];
        return std::array{WideChild{n.left, {n.left_min, n.left_max}},
                          WideChild{n.right, {n.right_min, n.right_max}}};
    };
    std::vector<WideChild> children;
    std::ranges::copy(both(node), std::back_inserter(children));
    const auto rank = [&](const WideChild& child) {
        return plan.becomes_leaf(child.reference) ? -1.0f : child.box.half_area();
    };
    while (children.size() < NEARLIGHT_WIDE_CHILDREN) {
        const auto widest = std::ranges::max_element(children, {}, rank);
        if (rank(*widest) < 0.0f) {
            break;
        }
        const uint opened = widest->reference;
        children.erase(widest);
        std::ranges::copy(both(opened), std::back_inserter(children));
    }
    double sum = 0.0;
    for (const WideChild& child : children) {
        if (!plan.becomes_leaf(child.reference)) {
            sum += child.box.half_area() + greedy_surface(bvh, plan, child.reference);
        }
    }
    return sum;
}

TEST(WideBvh, HasLessSurfaceThanTakingOverTheLargestChildren) {
    for (const float size : {0.02f, 0.2f}) {
        const Bvh bvh = test::build_all(test::random_soup(20000, size, 8));
        EXPECT_LT(surface_of_nodes(widen(bvh)), 0.97 * greedy_surface(bvh, CollapsePlan(bvh), 0));
    }
}

/// The checker's complaints about a sound tree after `corrupt` has changed it.
std::vector<std::string> complaints_after(const std::function<void(WideBvh&)>& corrupt) {
    const Bvh bvh = test::build_all(test::random_soup(200, 0.5f, 11));
    WideBvh wide = widen(bvh);
    corrupt(wide);
    return check_wide_bvh(wide, bvh);
}

TEST(WideBvhCheck, SeesWhatIsWrong) {
    EXPECT_THAT(complaints_after([](WideBvh&) {}), IsEmpty());
    EXPECT_THAT(complaints_after([](WideBvh& wide) { wide.nodes[1].high[2][0] -= 0.5f; }),
                Contains(HasSubstr("node 1 child 0: box")));
    EXPECT_THAT(complaints_after([](WideBvh& wide) { wide.nodes[0].child[0] = 0; }),
                Contains(HasSubstr("already in the tree")));
    EXPECT_THAT(complaints_after([](WideBvh& wide) { wide.nodes[0].child[0] = 12345; }),
                Contains(HasSubstr("out of range")));
    EXPECT_THAT(complaints_after([](WideBvh& wide) { wide.nodes.emplace_back(); }),
                Contains(HasSubstr("reached 0 times")));
    EXPECT_THAT(complaints_after([](WideBvh& wide) { wide.blocks[7].v0[1][0] += 1e-3f; }),
                Contains(HasSubstr("other triangles")));
    EXPECT_THAT(
        complaints_after([](WideBvh& wide) { std::swap(wide.triangle_ids[0], wide.triangle_ids[4]); }),
        Contains(HasSubstr("other triangles")));
    EXPECT_THAT(complaints_after([](WideBvh& wide) { wide.triangle_ids.pop_back(); }),
                Contains(HasSubstr("triangle ids")));
}

}  // namespace
}  // namespace nearlight::core
