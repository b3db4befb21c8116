// SPDX-License-Identifier: Apache-2.0
#include "host/scene/polygon.h"

#include <gtest/gtest.h>

#include <cmath>

namespace nearlight::core {
namespace {

using Triangles = std::vector<std::array<uint, 3>>;

/// Twice the area of the triangles as seen along `normal`; triangles that are turned over count negative, and
/// `turned` counts them.
double double_area(std::span<const Vec3> corners, const Triangles& triangles, Vec3 normal,
                   int* turned = nullptr) {
    double sum = 0;
    for (const auto& [a, b, c] : triangles) {
        const double area = dot(cross(corners[b] - corners[a], corners[c] - corners[a]), normal);
        sum += area;
        if (turned != nullptr && area < -1e-6) {
            ++*turned;
        }
    }
    return sum;
}

TEST(Polygon, ConvexOnesAreFans) {
    const std::vector<Vec3> square{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    EXPECT_TRUE(is_convex(square));
    EXPECT_EQ(triangulate(square), (Triangles{{0, 1, 2}, {0, 2, 3}}));
    EXPECT_EQ(triangulate(std::span(square).first(3)), (Triangles{{0, 1, 2}}));
}

TEST(Polygon, AnArrowIsCutAtItsNotch) {
    const std::vector<Vec3> arrow{{0, 0, 0}, {2, 1, 0}, {0, 2, 0}, {1, 1, 0}};
    EXPECT_FALSE(is_convex(arrow));
    for (const auto& triangle : triangulate(arrow)) {
        EXPECT_EQ(std::count(triangle.begin(), triangle.end(), 3u), 1) << "each triangle has the notch";
        EXPECT_EQ(std::count(triangle.begin(), triangle.end(), 1u), 1) << "and the tip";
    }
}

/// A star with ragged points, in a plane that lies askew.
std::vector<Vec3> star(uint corners, bool reversed) {
    std::vector<Vec3> points;
    for (uint i = 0; i < corners; ++i) {
        const float angle = 2.0f * kPi * static_cast<float>(i) / static_cast<float>(corners);
        const float radius = 1.0f + 0.7f * std::sin(37.0f * static_cast<float>(i * i));
        const float x = radius * std::cos(angle);
        const float y = radius * std::sin(angle);
        points.push_back({x + 5, y, 0.5f * x - 2 * y});
    }
    if (reversed) {
        std::ranges::reverse(points);
    }
    return points;
}

TEST(Polygon, EarsFillStarsExactly) {
    for (const uint corners : {5u, 8u, 33u, 200u}) {
        for (const bool reversed : {false, true}) {
            const std::vector<Vec3> points = star(corners, reversed);
            Vec3 normal{0, 0, 0};  // twice the area, by Newell's method
            for (std::size_t i = 0; i < points.size(); ++i) {
                normal += cross(points[i] - Vec3{5, 0, 0}, points[(i + 1) % points.size()] - Vec3{5, 0, 0});
            }
            int turned = 0;
            const Triangles triangles = triangulate(points);
            EXPECT_EQ(triangles.size(), points.size() - 2);
            EXPECT_NEAR(double_area(points, triangles, normalize(normal), &turned), length(normal),
                        1e-4 * length(normal));
            EXPECT_EQ(turned, 0) << corners;
        }
    }
}

TEST(Polygon, AHoleThatACutJoinsStaysEmpty) {
    const std::vector<Vec3> frame{{0, 0, 0}, {3, 0, 0}, {3, 3, 0}, {0, 3, 0}, {0, 0, 0},
                                  {1, 1, 0}, {1, 2, 0}, {2, 2, 0}, {2, 1, 0}, {1, 1, 0}};
    int turned = 0;
    EXPECT_NEAR(double_area(frame, triangulate(frame), {0, 0, 1}, &turned), 16.0, 1e-6);
    EXPECT_EQ(turned, 0);
}

TEST(Polygon, BrokenOnesGetSomeDivision) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    for (const std::vector<Vec3>& corners :
         {std::vector<Vec3>{{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}},       // crosses itself
          std::vector<Vec3>{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}},       // a point
          std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}},       // a line
          std::vector<Vec3>{{0, 0, 0}, {nan, 0, 0}, {2, 5, 0}, {3, 0, 0}}}) {  // nowhere
        EXPECT_EQ(triangulate(corners).size(), 2u);
    }
    EXPECT_EQ(triangulate(star(20'000, false)).size(), 19'998u);
}

}  // namespace
}  // namespace nearlight::core
