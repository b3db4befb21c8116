// SPDX-License-Identifier: Apache-2.0
// Directions that are uniform over the solid angle of a triangle, on the device and in the reference.
#include "host/reference/spherical_triangle.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "host/base/math.h"
#include "host/base/random.h"
#include "tests/support/device_fixture.h"
#include "tests/support/kernel_probe.h"

namespace nearlight::core {
namespace {

using test::KernelProbe;
using Corners = std::array<Vec3, 3>;

class SphericalTriangleTest : public test::DeviceTest {};

/// Triangles seen from the origin: an octant, one that nearly covers a hemisphere, usual ones, thin, distant
/// and tiny ones, and one at a grazing angle.
std::vector<Corners> triangles() {
    return {{Vec3{1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
            {Vec3{-50, -40, 0.05f}, {50, -40, 0.05f}, {0, 60, 0.05f}},
            {Vec3{-1, -1, 1.5f}, {2, -0.5f, 1}, {0.2f, 1.7f, 2}},
            {Vec3{0.1f, 0.2f, 0.05f}, {0.3f, -0.2f, 0.1f}, {-0.4f, 0.1f, 0.12f}},
            {Vec3{-0.6f, 1, 2}, {0.6f, 1, 2}, {0.6f, 1.004f, 2}},
            {Vec3{10, 10, 10}, {10.3f, 10, 10}, {10, 10.3f, 10}},
            {Vec3{1, 2, 3}, {1.02f, 2, 3}, {1, 2.02f, 3}},
            {Vec3{-1, 0.01f, 1}, {1, 0.01f, 1}, {0, 0.011f, 3}}};
}

/// The solid angle by l'Huilier's theorem, from the sides.
double huilier(const Corners& corners) {
    const auto side = [](Vec3 p, Vec3 q) {
        const double a[3] = {p.x, p.y, p.z};
        const double b[3] = {q.x, q.y, q.z};
        double la = 0, lb = 0;
        for (int i = 0; i < 3; ++i) {
            la += a[i] * a[i];
            lb += b[i] * b[i];
        }
        double squared = 0;
        for (int i = 0; i < 3; ++i) {
            const double d = a[i] / std::sqrt(la) - b[i] / std::sqrt(lb);
            squared += d * d;
        }
        return 2 * std::asin(std::min(1.0, 0.5 * std::sqrt(squared)));
    };
    const double a = side(corners[1], corners[2]);
    const double b = side(corners[2], corners[0]);
    const double c = side(corners[0], corners[1]);
    const double s = 0.5 * (a + b + c);
    const double product =
        std::tan(s / 2) * std::tan((s - a) / 2) * std::tan((s - b) / 2) * std::tan((s - c) / 2);
    return 4 * std::atan(std::sqrt(std::max(0.0, product)));
}

/// Weights of the corners at which the direction meets the plane of the triangle.
std::array<double, 3> weights_of(const Corners& corners, Vec3 d) {
    const auto determinant = [](Vec3 p, Vec3 q, Vec3 r) {
        return double(p.x) * (double(q.y) * r.z - double(q.z) * r.y) -
               double(p.y) * (double(q.x) * r.z - double(q.z) * r.x) +
               double(p.z) * (double(q.x) * r.y - double(q.y) * r.x);
    };
    const double a = determinant(d, corners[1], corners[2]);
    const double b = determinant(corners[0], d, corners[2]);
    const double c = determinant(corners[0], corners[1], d);
    return {a / (a + b + c), b / (a + b + c), c / (a + b + c)};
}

constexpr int kLevels = 3;

/// The solid angles of the parts into which `kLevels` halvings of the edges cut the triangle.
void collect_shares(const Corners& c, int level, std::vector<double>& shares) {
    if (level == kLevels) {
        shares.push_back(huilier(c));
        return;
    }
    const Vec3 m0 = (c[1] + c[2]) * 0.5f;
    const Vec3 m1 = (c[2] + c[0]) * 0.5f;
    const Vec3 m2 = (c[0] + c[1]) * 0.5f;
    collect_shares({c[0], m2, m1}, level + 1, shares);
    collect_shares({m2, c[1], m0}, level + 1, shares);
    collect_shares({m1, m0, c[2]}, level + 1, shares);
    collect_shares({m0, m1, m2}, level + 1, shares);
}

/// Counts directions in the 64 parts into which three halvings of the edges cut the triangle, and compares
/// them with the parts' shares of the solid angle by Pearson's chi².
void expect_uniform(const Corners& corners, const std::vector<Vec3>& directions) {
    std::vector<double> shares;
    std::vector<std::size_t> order;
    std::vector<double> counts(64, 0.0);
    double outside = 0;
    for (const Vec3 direction : directions) {
        std::array<double, 3> w = weights_of(corners, direction);
        outside += std::min({w[0], w[1], w[2]}) < -1e-3 ? 1 : 0;
        std::size_t part = 0;
        for (int level = 0; level < kLevels; ++level) {
            const auto big = static_cast<std::size_t>(std::max_element(w.begin(), w.end()) - w.begin());
            if (w[big] >= 0.5) {
                for (std::size_t i = 0; i < 3; ++i) {
                    w[i] = i == big ? 2 * w[i] - 1 : 2 * w[i];
                }
                part = 4 * part + big;
            } else {
                for (double& x : w) {
                    x = 1 - 2 * x;
                }
                part = 4 * part + 3;
            }
        }
        counts[part] += 1;
    }
    EXPECT_EQ(outside, 0);
    collect_shares(corners, 0, shares);
    const double total = huilier(corners);
    double chi2 = 0;
    int parts = 0;
    double rest = 0;  // parts that are too small to count by themselves
    double rest_count = 0;
    for (std::size_t i = 0; i < shares.size(); ++i) {
        const double expected = shares[i] / total * static_cast<double>(directions.size());
        if (expected < 10) {
            rest += expected;
            rest_count += counts[i];
            continue;
        }
        chi2 += (counts[i] - expected) * (counts[i] - expected) / expected;
        ++parts;
    }
    if (rest > 10) {
        chi2 += (rest_count - rest) * (rest_count - rest) / rest;
        ++parts;
    }
    // Beyond five standard deviations of chi², which has parts − 1 degrees of freedom.
    EXPECT_LT(chi2, parts - 1 + 5 * std::sqrt(2.0 * parts)) << parts << " parts";
}

TEST_F(SphericalTriangleTest, ReferenceIsUniformOverTheSolidAngle) {
    Pcg32 random(4);
    for (const Corners& corners : triangles()) {
        const SphericalTriangle seen(corners, {0, 0, 0});
        SCOPED_TRACE(seen.solid_angle());
        EXPECT_NEAR(seen.solid_angle(), huilier(corners), 1e-6 * huilier(corners) + 1e-12);
        std::vector<Vec3> directions;
        for (int i = 0; i < 65536; ++i) {
            const float x = random.uniform();
            directions.push_back(seen.sample({x, random.uniform()}));
        }
        expect_uniform(corners, directions);
    }
    EXPECT_EQ(SphericalTriangle({Vec3{1, 0, 0}, {2, 0, 0}, {3, 0, 0}}, {0, 0, 0}).solid_angle(), 0.0);
}

TEST_F(SphericalTriangleTest, DeviceIsUniformOverTheSolidAngle) {
    constexpr uint kCount = 65536;
    on_each_device([&](Device& device) {
        KernelProbe probe(device,
                          "#include \"lib/light/spherical_triangle.cl\"\n"
                          "#include \"lib/random.cl\"\n"
                          "kernel void probe(float4 a, float4 b, float4 c, global float4* out) {\n"
                          "    const uint i = get_global_id(0);\n"
                          "    const float3 x = (float3)(0.0f);\n"
                          "    const float facing = -dot(a.xyz, cross(b.xyz - a.xyz, c.xyz - a.xyz));\n"
                          "    const SphericalTriangle seen = facing > 0.0f ?\n"
                          "        seen_triangle(a.xyz, b.xyz - a.xyz, c.xyz - a.xyz, x) :\n"
                          "        seen_triangle(a.xyz, c.xyz - a.xyz, b.xyz - a.xyz, x);\n"
                          "    const uint4 words = random_uint4((uint4)(i, 1, 2, 3));\n"
                          "    const float2 u = (float2)(to_unit_float(words.x), to_unit_float(words.y));\n"
                          "    out[i] = (float4)(sample_spherical_triangle(&seen, u), seen.solid_angle);\n"
                          "}\n");
        Buffer<std::array<float, 4>> out(probe.device(), kCount);
        for (const Corners& corners : triangles()) {
            std::array<std::array<float, 4>, 3> c{};
            for (std::size_t i = 0; i < 3; ++i) {
                c[i] = {corners[i].x, corners[i].y, corners[i].z, 0};
            }
            probe.kernel().launch(kCount, 8, c[0], c[1], c[2], out);
            std::vector<Vec3> directions;
            float solid_angle = 0;
            for (const auto& [x, y, z, w] : out.download()) {
                directions.push_back({x, y, z});
                solid_angle = w;
            }
            SCOPED_TRACE(huilier(corners));
            EXPECT_NEAR(solid_angle, huilier(corners), 1e-4 * huilier(corners));
            expect_uniform(corners, directions);
        }
    });
}

}  // namespace
}  // namespace nearlight::core
