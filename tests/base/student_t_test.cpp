// SPDX-License-Identifier: Apache-2.0
#include "host/base/student_t.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace nearlight::core {
namespace {

TEST(StudentT, QuantilesAreThoseOfTheTables) {
    constexpr std::array<std::pair<double, double>, 8> kTable{{{1, 12.7062},
                                                               {2, 4.30265},
                                                               {3, 3.18245},
                                                               {4, 2.77645},
                                                               {5, 2.57058},
                                                               {10, 2.22814},
                                                               {30, 2.04227},
                                                               {100, 1.98397}}};
    for (const auto& [freedom, quantile] : kTable) {
        EXPECT_NEAR(student_t_quantile(0.05, freedom), quantile, 5e-6 * quantile) << freedom;
    }
    EXPECT_NEAR(student_t_quantile(0.001, 1), 636.619, 1e-3);
}

TEST(StudentT, TailsAreThoseOfTheTables) {
    EXPECT_NEAR(student_t_tail(2.0687, 23), 0.05, 1e-5);
    EXPECT_NEAR(student_t_tail(-3.7676, 23), 0.001, 1e-6);
    EXPECT_NEAR(student_t_tail(4.4172, 1e7), 1e-5, 1e-8);
    EXPECT_EQ(student_t_tail(0.0, 5), 1.0);
}

// With one degree of freedom Student's t is Cauchy's distribution, with two its integral is algebraic, and
// with very many it is the normal distribution.
TEST(StudentT, TailsAreThoseOfClosedForms) {
    for (const double t : {1e-6, 0.1, 1.0, 1.7, 3.0, 40.0, 1e5}) {
        const double cauchy = 2.0 / std::numbers::pi * std::atan2(1.0, t);
        EXPECT_NEAR(student_t_tail(t, 1), cauchy, 1e-13 * cauchy) << t;
        const double root = std::sqrt(2.0 + t * t);
        const double two = 2.0 / (root * (root + t));
        EXPECT_NEAR(student_t_tail(t, 2), two, 1e-13 * two) << t;
    }
    for (const double t : {0.1, 1.0, 2.0, 4.0}) {
        const double normal = std::erfc(t / std::numbers::sqrt2);
        EXPECT_NEAR(student_t_tail(t, 1e8), normal, 1e-6 * normal) << t;
    }
}

TEST(StudentT, QuantilesInvertTailsAlsoBetweenWholeDegreesOfFreedom) {
    for (const double freedom : {0.7, 1.0, 2.5, 23.0, 1234.5}) {
        for (const double probability : {0.9, 0.05, 1e-4, 1e-9}) {
            const double t = student_t_quantile(probability, freedom);
            EXPECT_NEAR(student_t_tail(t, freedom), probability, 1e-12 * probability) << freedom;
        }
    }
}

}  // namespace
}  // namespace nearlight::core
