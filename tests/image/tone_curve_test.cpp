// SPDX-License-Identifier: Apache-2.0
#include "host/image/tone_curve.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace nearlight::core {
namespace {

constexpr ToneCurve kBent[] = {ToneCurve::neutral, ToneCurve::agx, ToneCurve::filmic};

float grey_at(ToneCurve curve, float x) {
    return apply_tone_curve(curve, {x, x, x}).y;
}

TEST(ToneCurve, AllHaveNames) {
    EXPECT_EQ(kToneCurves.size(), 4u);
    EXPECT_EQ(to_string(ToneCurve::agx), "agx");
    EXPECT_EQ(to_string(ToneCurve::linear), "linear");
}

TEST(ToneCurve, TheyRiseFromBlackToWhite) {
    for (const ToneCurve curve : kBent) {
        SCOPED_TRACE(to_string(curve));
        EXPECT_NEAR(grey_at(curve, 0.0f), 0.0f, 1e-3f);
        float last = grey_at(curve, 1e-4f);
        for (float x = 2e-4f; x < 30.0f; x *= 1.3f) {
            const float now = grey_at(curve, x);
            EXPECT_GE(now, last - 1e-6f) << x;
            last = now;
        }
        EXPECT_GT(last, 0.9f);
        EXPECT_LE(last, 1.0f);
    }
}

TEST(ToneCurve, MiddleGreyAndColoursStayWhereTheyShould) {
    EXPECT_NEAR(grey_at(ToneCurve::agx, 0.18f), 0.18f, 2e-3f);
    EXPECT_NEAR(grey_at(ToneCurve::neutral, 0.5f), 0.46f, 1e-6f);  // less the reflection of 0.04
    const Vec3 red = apply_tone_curve(ToneCurve::neutral, {0.6f, 0.2f, 0.2f});
    EXPECT_NEAR(red.x - red.y, 0.4f, 1e-6f);
    const Vec3 linear = apply_tone_curve(ToneCurve::linear, {3, -1, 0.5f});
    EXPECT_EQ(linear, (Vec3{3, -1, 0.5f}));
}

TEST(ToneCurve, BadNumbersBecomeBlackOrWhite) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const float infinity = std::numeric_limits<float>::infinity();
    for (const ToneCurve curve : kBent) {
        const Vec3 shown = apply_tone_curve(curve, {nan, infinity, -infinity});
        EXPECT_TRUE(is_finite(shown)) << to_string(curve);
        EXPECT_GE(shown.x, 0.0f);
        EXPECT_LE(shown.y, 1.0f);
    }
}

}  // namespace
}  // namespace nearlight::core
