// SPDX-License-Identifier: Apache-2.0
#include "host/bvh/wide_bvh.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "tests/bvh/soup.h"

namespace nearlight {
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
    // Sixteen triangles a leaf fill four blocks.
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

/// Complaints about a sound tree after `corrupt` was at it.
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
}

}  // namespace
}  // namespace nearlight
