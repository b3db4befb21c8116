// SPDX-License-Identifier: Apache-2.0
#include "host/session/line_waists.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace nearlight::core {
namespace {

/// Half lines from the square |x|, |y| < 2 at z = 0 through a disk that faces it.
std::vector<HalfLine> lines_through(Vec3 center, float radius, std::size_t count, Pcg32& random) {
    std::vector<HalfLine> lines;
    for (std::size_t i = 0; i < count; ++i) {
        const Vec3 origin{4 * random.uniform() - 2, 4 * random.uniform() - 2, 0};
        const float r = radius * std::sqrt(random.uniform());
        const float angle = 2 * kPi * random.uniform();
        const Vec3 through = center + Vec3{r * std::cos(angle), r * std::sin(angle), 0};
        lines.push_back({origin, normalize(through - origin)});
    }
    return lines;
}

/// The share of the lines through waists whose centres are within `reach` of the place.
float share_near(const std::vector<Waist>& waists, Vec3 place, float reach) {
    float share = 0;
    for (const Waist& waist : waists) {
        share += length(waist.center - place) < reach ? waist.share : 0.0f;
    }
    return share;
}

TEST(LineWaistsTest, DistanceToAHalfLineIsThatToItsNearestPoint) {
    const HalfLine line{{1, 0, 0}, {0, 0, 1}};
    EXPECT_FLOAT_EQ(distance_to(line, {1, 3, 5}), 3.0f);
    EXPECT_FLOAT_EQ(distance_to(line, {1, 3, -4}), 5.0f) << "behind its origin";
}

TEST(LineWaistsTest, FindsOneWindow) {
    Pcg32 random(1);
    const Vec3 window{1, 0.5f, 3};
    const std::vector<Waist> waists = find_waists(lines_through(window, 0.4f, 300, random), 1, Pcg32(2));
    ASSERT_EQ(waists.size(), 1u);
    EXPECT_LT(length(waists[0].center - window), 0.1f);
    EXPECT_NEAR(waists[0].radius, 0.37f, 0.05f) << "85 % of a disk's area";
    EXPECT_EQ(waists[0].share, 1.0f);
    EXPECT_NEAR(length(waists[0].direction), 1.0f, 1e-5f);
    EXPECT_GT(dot(waists[0].direction, normalize(window)), 0.98f);
}

TEST(LineWaistsTest, FindsSeveralWindowsAndTheirShares) {
    Pcg32 random(3);
    const Vec3 windows[] = {{-4, 0, 3}, {0, 1, 6}, {5, -1, 4}};
    const std::size_t counts[] = {300, 100, 200};
    std::vector<HalfLine> lines;
    for (int i = 0; i < 3; ++i) {
        const std::vector<HalfLine> some = lines_through(windows[i], 0.3f, counts[i], random);
        lines.insert(lines.end(), some.begin(), some.end());
    }
    const std::vector<Waist> waists = find_waists(lines, 8, Pcg32(4));
    EXPECT_LE(waists.size(), 8u);
    for (int i = 0; i < 3; ++i) {
        EXPECT_NEAR(share_near(waists, windows[i], 1.5f), static_cast<float>(counts[i]) / 600, 0.05f) << i;
    }
    for (const Waist& waist : waists) {
        EXPECT_LT(waist.radius, 0.35f);
    }
}

TEST(LineWaistsTest, StrayLinesDoNotMoveAWaist) {
    Pcg32 random(5);
    const Vec3 window{0, 0, 4};
    std::vector<HalfLine> lines = lines_through(window, 0.3f, 200, random);
    const std::vector<HalfLine> stray = lines_through({6, 0, 4}, 5.0f, 20, random);
    lines.insert(lines.end(), stray.begin(), stray.end());
    const std::vector<Waist> waists = find_waists(lines, 1, Pcg32(6));
    ASSERT_EQ(waists.size(), 1u);
    EXPECT_LT(length(waists[0].center - window), 0.4f);
}

/// Parallel lines do not tell where along them they pass, so the waist is among their origins.
TEST(LineWaistsTest, ParallelLinesHaveTheirWaistAmongTheirOrigins) {
    std::vector<HalfLine> lines;
    for (int i = 0; i < 40; ++i) {
        lines.push_back({{0.01f * static_cast<float>(i), 0, 7}, {0, 0, 1}});
    }
    const std::vector<Waist> waists = find_waists(lines, 1, Pcg32(7));
    ASSERT_EQ(waists.size(), 1u);
    EXPECT_TRUE(is_finite(waists[0].center));
    EXPECT_NEAR(waists[0].center.z, 7.0f, 0.1f);
    EXPECT_NEAR(waists[0].center.x, 0.195f, 0.05f);
}

TEST(LineWaistsTest, TooFewLinesHaveNoWaist) {
    Pcg32 random(8);
    EXPECT_TRUE(find_waists({}, 8, Pcg32(9)).empty());
    EXPECT_TRUE(find_waists(lines_through({0, 0, 3}, 0.3f, 23, random), 8, Pcg32(9)).empty());
    EXPECT_FALSE(find_waists(lines_through({0, 0, 3}, 0.3f, 24, random), 8, Pcg32(9)).empty());
}

}  // namespace
}  // namespace nearlight::core
