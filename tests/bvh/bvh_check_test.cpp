// SPDX-License-Identifier: Apache-2.0
// The checker must find each kind of corruption.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "tests/bvh/soup.h"

namespace nearlight::core {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;

/// The checker's complaints about a sound tree after `corrupt` has changed it.
std::vector<std::string> complaints_after(const std::function<void(Bvh&)>& corrupt) {
    const Scene scene = test::random_soup(200, 0.5f, 11);
    Bvh bvh = test::build_all(scene);
    corrupt(bvh);
    return check_bvh(bvh, scene, test::all_ids(scene));
}

/// An inner node whose left child is an inner node.
BvhNode& inner_parent(Bvh& bvh) {
    for (BvhNode& node : bvh.nodes) {
        if ((node.left & NEARLIGHT_LEAF_BIT) == 0) {
            return node;
        }
    }
    throw std::logic_error("no inner child");
}

TEST(BvhCheck, ASoundTreePasses) {
    EXPECT_THAT(complaints_after([](Bvh&) {}), IsEmpty());
}

TEST(BvhCheck, BoxTooSmall) {
    EXPECT_THAT(complaints_after([](Bvh& bvh) { bvh.nodes[5].right_max.y -= 0.1f; }),
                Contains(HasSubstr("node 5 right: box")));
}

TEST(BvhCheck, BoxNotANumber) {
    EXPECT_THAT(complaints_after([](Bvh& bvh) { bvh.nodes[0].left_min.x = std::nanf(""); }),
                Contains(HasSubstr("node 0 left: box")));
}

TEST(BvhCheck, NodeOutOfRange) {
    EXPECT_THAT(complaints_after([](Bvh& bvh) { inner_parent(bvh).left = 100000; }),
                Contains(HasSubstr("out of range")));
}

TEST(BvhCheck, Cycle) {
    EXPECT_THAT(complaints_after([](Bvh& bvh) { inner_parent(bvh).left = 0; }),
                Contains(HasSubstr("already in the tree")));
}

TEST(BvhCheck, LeafOutOfRange) {
    EXPECT_THAT(complaints_after([](Bvh& bvh) { inner_parent(bvh).left = NEARLIGHT_LEAF_BIT | 100000u; }),
                Contains(HasSubstr("leaf out of range")));
}

TEST(BvhCheck, LostSubtree) {
    const auto complaints = complaints_after([](Bvh& bvh) { bvh.nodes[0].left = bvh.nodes[0].right; });
    EXPECT_THAT(complaints, Contains(HasSubstr("not in the tree")));
    EXPECT_THAT(complaints, Contains(HasSubstr("in 0 leaves")));
}

TEST(BvhCheck, MissingAndRepeatedTriangle) {
    EXPECT_THAT(complaints_after([](Bvh& bvh) {
                    bvh.triangle_ids[3] = bvh.triangle_ids[4];
                    bvh.triangles[3] = bvh.triangles[4];
                }),
                Contains(HasSubstr("other triangles than asked for")));
}

TEST(BvhCheck, AlteredTriangle) {
    EXPECT_THAT(complaints_after([](Bvh& bvh) { bvh.triangles[7].edge2.z += 1e-3f; }),
                Contains(HasSubstr("triangle 7: differs from that of the scene")));
}

TEST(BvhCheck, AlteredNormal) {
    EXPECT_THAT(complaints_after([](Bvh& bvh) { bvh.triangles[7].normal *= -1.0f; }),
                Contains(HasSubstr("triangle 7: normal")));
}

TEST(BvhCheck, WrongDepthAndUnequalArrays) {
    EXPECT_THAT(complaints_after([](Bvh& bvh) { ++bvh.depth; }), Contains(HasSubstr("depth is")));
    EXPECT_THAT(complaints_after([](Bvh& bvh) { bvh.triangle_ids.pop_back(); }),
                Contains(HasSubstr("unequal length")));
}

}  // namespace
}  // namespace nearlight::core
