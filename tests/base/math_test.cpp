// SPDX-License-Identifier: Apache-2.0
#include "host/base/math.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "host/base/random.h"

namespace nearlight::core {
namespace {

void expect_near(Vec3 a, Vec3 b, float tolerance = 1e-5f) {
    EXPECT_NEAR(a.x, b.x, tolerance);
    EXPECT_NEAR(a.y, b.y, tolerance);
    EXPECT_NEAR(a.z, b.z, tolerance);
}

TEST(Math, InverseUndoesATransform) {
    const Mat4 m = translation(1, -2, 3) * rotation(1, 2, 3, 40) * scaling(2, 3, -0.5);
    const Vec3 p{0.3f, -4.0f, 7.0f};
    expect_near(transform_point(inverse(m), transform_point(m, p)), p);
    EXPECT_LT(linear_determinant(m), 0.0);
}

TEST(Math, SingularMatrixIsRefused) {
    EXPECT_THROW(inverse(scaling(1, 0, 1)), std::domain_error);
}

TEST(Math, RotationIsCounterClockwiseSeenFromTheTipOfTheAxis) {
    expect_near(transform_vector(rotation(0, 0, 2, 90), {1, 0, 0}), {0, 1, 0});
    expect_near(transform_vector(rotation(0, 5, 0, 90), {0, 0, 1}), {1, 0, 0});
}

TEST(Math, LookAtPointsZAtTheTargetAndYUp) {
    const Mat4 m = look_at({1, 2, 3}, {1, 2, 13}, {0, 1, 0});
    expect_near(transform_vector(m, {0, 0, 1}), {0, 0, 1});
    expect_near(transform_vector(m, {0, 1, 0}), {0, 1, 0});
    expect_near(transform_point(m, {0, 0, 0}), {1, 2, 3});
}

TEST(Math, NormalsStayPerpendicularUnderShear) {
    Mat4 shear;
    shear(0, 1) = 2.0;
    const Vec3 tangent = transform_vector(shear, {0, 1, 0});
    const Vec3 normal = transform_normal_by_inverse(inverse(shear), {1, 0, 0});
    EXPECT_NEAR(dot(tangent, normal), 0.0f, 1e-6f);
}

TEST(Math, OrthonormalBasisIsRightHandedEverywhere) {
    Pcg32 random(7);
    for (int i = 0; i < 1000; ++i) {
        Vec3 n = normalize({random.uniform() - 0.5f, random.uniform() - 0.5f, random.uniform() - 0.5f});
        if (i == 0) {
            n = {0, 0, -1};
        }
        const auto [t, b] = orthonormal_basis(n);
        expect_near(cross(t, b), n, 1e-5f);
        EXPECT_NEAR(length(t), 1.0f, 1e-5f);
    }
}

TEST(Random, UniformStaysBelowOneAndHasTheRightMean) {
    Pcg32 random(1);
    double sum = 0;
    for (int i = 0; i < 100000; ++i) {
        const float u = random.uniform();
        ASSERT_GE(u, 0.0f);
        ASSERT_LT(u, 1.0f);
        sum += u;
    }
    EXPECT_NEAR(sum / 100000, 0.5, 5 * 0.2887 / 316.2);
}

}  // namespace
}  // namespace nearlight::core
