// SPDX-License-Identifier: Apache-2.0
#include "host/stages/importon_groups.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "host/base/math.h"
#include "host/base/random.h"

namespace nearlight::core {
namespace {

/// Numbered importons on two walls, which face each other, of a room 4 m wide.
std::vector<Importon> on_two_walls(uint count) {
    Pcg32 random(2);
    std::vector<Importon> importons(count);
    for (uint i = 0; i < count; ++i) {
        const float side = i % 2 == 0 ? -1.0f : 1.0f;
        const float y = random.uniform();
        importons[i].position = {2 * side, y, random.uniform()};
        importons[i].normal = {-side, 0, 0};
        importons[i].pad0 = i;
    }
    return importons;
}

TEST(ImportonGroups, AreOfNearlyEqualSizeAndHoldEachOnce) {
    for (const std::size_t wanted : {1u, 2u, 7u, 64u}) {
        const auto groups = group_importons(on_two_walls(200), wanted);
        ASSERT_EQ(groups.size(), wanted);
        std::vector<uint> seen;
        for (const std::vector<Importon>& group : groups) {
            EXPECT_NEAR(static_cast<double>(group.size()), 200.0 / static_cast<double>(wanted), 1.5);
            std::ranges::transform(group, std::back_inserter(seen), &Importon::pad0);
        }
        std::ranges::sort(seen);
        ASSERT_EQ(seen.size(), 200u);
        EXPECT_TRUE(std::ranges::adjacent_find(seen) == seen.end());
    }
}

TEST(ImportonGroups, KeepApartWhatIsFarApart) {
    for (const std::vector<Importon>& group : group_importons(on_two_walls(256), 16)) {
        Vec3 low = group[0].position;
        Vec3 high = low;
        for (const Importon& importon : group) {
            low = {std::min(low.x, importon.position.x), std::min(low.y, importon.position.y),
                   std::min(low.z, importon.position.z)};
            high = {std::max(high.x, importon.position.x), std::max(high.y, importon.position.y),
                    std::max(high.z, importon.position.z)};
        }
        EXPECT_LT(length(high - low), 0.9f);
    }
}

TEST(ImportonGroups, NoneIsEmpty) {
    EXPECT_TRUE(group_importons({}, 64).empty());
    EXPECT_TRUE(group_importons(on_two_walls(3), 0).empty());
    EXPECT_EQ(group_importons(on_two_walls(3), 64).size(), 3u);
    EXPECT_EQ(group_importons(std::vector<Importon>(100, on_two_walls(1)[0]), 64).size(), 64u)
        << "all in one place";
}

}  // namespace
}  // namespace nearlight::core
