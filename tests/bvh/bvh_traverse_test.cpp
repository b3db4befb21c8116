// SPDX-License-Identifier: Apache-2.0
// Compares the traversal with a loop over all triangles in double precision.
#include <gtest/gtest.h>

#include <cmath>

#include "host/base/math.h"
#include "tests/bvh/soup.h"

namespace nearlight::core {
namespace {

struct Double3 {
    double x, y, z;
};
Double3 widen(Vec3 v) {
    return {v.x, v.y, v.z};
}
Double3 operator-(Double3 a, Double3 b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
double dot(Double3 a, Double3 b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
Double3 cross(Double3 a, Double3 b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

struct ExactHit {
    double t = kInfinity;
    uint triangle = ~0u;
    double margin = kInfinity;  ///< minimum over all triangles of the distance at which the decision changes
};

/// Cramer's rule for o + t·d = v0 + u·e1 + v·e2.
ExactHit brute_force(const Scene& scene, Vec3 origin, Vec3 direction, double t_min, double t_max) {
    ExactHit best;
    best.t = t_max;
    for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
        const Triangle& triangle = scene.triangles[i];
        const Double3 v0 = widen(scene.vertices[triangle.v0].position);
        const Double3 e1 = widen(scene.vertices[triangle.v1].position) - v0;
        const Double3 e2 = widen(scene.vertices[triangle.v2].position) - v0;
        const Double3 d = widen(direction);
        const Double3 p = cross(d, e2);
        const double det = dot(e1, p);
        if (det == 0.0) {
            continue;
        }
        const Double3 s = widen(origin) - v0;
        const Double3 q = cross(s, e1);
        const double u = dot(s, p) / det;
        const double v = dot(d, q) / det;
        const double t = dot(e2, q) / det;
        const double inside = std::min({u, v, 1.0 - u - v});
        if (t > t_min && t < t_max) {
            best.margin = std::min(best.margin, std::abs(inside));
        }
        if (inside >= 0.0 && t > t_min && t < best.t) {
            best.t = t;
            best.triangle = static_cast<uint>(i);
        }
    }
    return best;
}

/// Returns whether the ray could be compared: false where it passes an edge too closely to tell.
bool compare(const Scene& scene, const Bvh& bvh, Vec3 origin, Vec3 direction, float t_min, float t_max) {
    const ExactHit exact = brute_force(scene, origin, direction, t_min, t_max);
    const BvhHit hit = closest_hit(bvh, origin, direction, t_min, t_max);
    EXPECT_EQ(occluded(bvh, origin, direction, t_min, t_max), hit.triangle != ~0u);
    if (exact.margin < 1e-4) {
        return false;
    }
    EXPECT_EQ(hit.triangle != ~0u, exact.triangle != ~0u);
    if (hit.triangle != ~0u && exact.triangle != ~0u) {
        EXPECT_NEAR(hit.t, exact.t, 1e-3 * (1.0 + exact.t));
    }
    return true;
}

TEST(BvhTraverse, RandomRays) {
    for (const float size : {0.2f, 3.0f}) {
        const Scene scene = test::random_soup(1000, size, 21);
        const Bvh bvh = test::build_all(scene);
        Pcg32 random(22);
        int compared = 0;
        for (int i = 0; i < 2000; ++i) {
            const Vec3 origin = test::random_point(random, 14.0f);
            const Vec3 direction = test::random_point(random, 2.0f);
            compared += compare(scene, bvh, origin, direction, 0.0f, i % 2 == 0 ? kInfinity : 3.0f) ? 1 : 0;
        }
        EXPECT_GT(compared, 1000);
    }
}

TEST(BvhTraverse, AxisAlignedRaysThroughAxisAlignedTriangles) {
    const Scene scene = test::aligned_squares(6);
    const Bvh bvh = test::build_all(scene);
    Pcg32 random(23);
    int hits = 0;
    for (int i = 0; i < 3000; ++i) {
        // Every third ray has its transverse coordinates in the planes of squares and on their edges.
        const bool on_planes = i % 3 == 0;
        const auto coordinate = [&] {
            return on_planes ? std::floor(random.uniform() * 6) : random.uniform() * 6;
        };
        const float a = coordinate();
        const float b = coordinate();
        const float sign = i % 2 == 0 ? 1.0f : -1.0f;
        const float start = sign > 0 ? -1.0f : 7.0f;
        const int axis = i / 6 % 3;
        const Vec3 origin =
            axis == 0 ? Vec3{start, a, b} : (axis == 1 ? Vec3{a, start, b} : Vec3{a, b, start});
        const float zero = i % 4 < 2 ? 0.0f : -0.0f;
        const Vec3 direction = axis == 0 ? Vec3{sign, zero, zero}
                                         : (axis == 1 ? Vec3{zero, sign, zero} : Vec3{zero, zero, sign});
        // These coordinates are exact in single precision, so even rays through edges must agree.
        const ExactHit exact = brute_force(scene, origin, direction, 0.0, 100.0);
        const BvhHit hit = closest_hit(bvh, origin, direction, 0.0f, 100.0f);
        if (on_planes || exact.margin > 1e-5) {
            ASSERT_EQ(hit.triangle != ~0u, exact.triangle != ~0u) << "ray " << i;
        }
        if (hit.triangle != ~0u && exact.triangle != ~0u) {
            ASSERT_NEAR(hit.t, exact.t, 1e-5);
            ++hits;
        }
    }
    EXPECT_GT(hits, 1000);
}

TEST(BvhTraverse, GrazingRays) {
    const Scene scene = test::aligned_squares(5);
    const Bvh bvh = test::build_all(scene);
    Pcg32 random(24);
    int compared = 0;
    for (int i = 0; i < 2000; ++i) {
        const Vec3 origin{-2.0f, random.uniform() * 5, random.uniform() * 5};
        const Vec3 direction{1.0f, (random.uniform() - 0.5f) * 1e-2f, (random.uniform() - 0.5f) * 1e-2f};
        compared += compare(scene, bvh, origin, direction, 0.0f, kInfinity) ? 1 : 0;
    }
    EXPECT_GT(compared, 1000);
}

TEST(BvhTraverse, BothSidesAndBarycentrics) {
    Scene scene = test::scene_of_one_material();
    test::add_triangle(scene, {0, 0, 0}, {4, 0, 0}, {0, 4, 0});
    const Bvh bvh = test::build_all(scene);
    for (const float z : {2.0f, -2.0f}) {
        const BvhHit hit = closest_hit(bvh, {1, 2, z}, {0, 0, -0.5f * z}, 0.0f, kInfinity);
        EXPECT_EQ(hit.triangle, 0u);
        EXPECT_FLOAT_EQ(hit.t, 2.0f);
        EXPECT_FLOAT_EQ(hit.u, 0.25f);
        EXPECT_FLOAT_EQ(hit.v, 0.5f);
    }
}

TEST(BvhTraverse, TheEndsOfTheIntervalAreExcluded) {
    Scene scene = test::scene_of_one_material();
    test::add_triangle(scene, {0, 0, 0}, {4, 0, 0}, {0, 4, 0});
    const Bvh bvh = test::build_all(scene);
    const auto hits = [&](float t_min, float t_max) {
        return occluded(bvh, {1, 1, 1}, {0, 0, -1}, t_min, t_max);
    };
    EXPECT_TRUE(hits(0.5f, 1.5f));
    EXPECT_FALSE(hits(1.0f, 2.0f));
    EXPECT_FALSE(hits(0.0f, 1.0f));
    EXPECT_TRUE(hits(std::nextafter(1.0f, 0.0f), std::nextafter(1.0f, 2.0f)));
}

TEST(BvhTraverse, NotANumberAndInfinityHitNothing) {
    const Scene scene = test::random_soup(2000, 4.0f, 25);
    const Bvh bvh = test::build_all(scene);
    ASSERT_TRUE(occluded(bvh, {-20, 0, 0}, {1, 0.01f, 0.02f}, 0.0f, kInfinity));
    for (const float bad : {std::nanf(""), kInfinity, -kInfinity}) {
        EXPECT_FALSE(occluded(bvh, {-20, bad, 0}, {1, 0.01f, 0.02f}, 0.0f, kInfinity));
        EXPECT_FALSE(occluded(bvh, {-20, 0, 0}, {1, bad, 0.02f}, 0.0f, kInfinity));
    }
    EXPECT_FALSE(occluded(bvh, {-20, 0, 0}, {1, 0.01f, 0.02f}, std::nanf(""), kInfinity));
    EXPECT_FALSE(occluded(bvh, {-20, 0, 0}, {1, 0.01f, 0.02f}, 0.0f, std::nanf("")));
    EXPECT_FALSE(occluded(bvh, {0, 0, 0}, {0, 0, 0}, 0.0f, kInfinity));
}

TEST(BvhTraverse, AnEmptyTreeAndDegenerateTrianglesAreNeverHit) {
    Scene scene = test::scene_of_one_material();
    EXPECT_FALSE(occluded(test::build_all(scene), {0, 0, 0}, {1, 1, 1}, 0.0f, kInfinity));
    test::add_triangle(scene, {1, 1, 1}, {1, 1, 1}, {1, 1, 1});
    test::add_triangle(scene, {1, 0, 0}, {1, 1, 0}, {1, 2, 0});
    EXPECT_FALSE(occluded(test::build_all(scene), {0, 0, 0}, {1, 1, 1}, 0.0f, kInfinity));
    EXPECT_FALSE(occluded(test::build_all(scene), {0, 1, 0}, {1, 0, 0}, 0.0f, kInfinity));
}

}  // namespace
}  // namespace nearlight::core
