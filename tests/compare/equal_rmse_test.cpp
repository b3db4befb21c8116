// SPDX-License-Identifier: Apache-2.0
#include "host/compare/equal_rmse.h"

#include <gtest/gtest.h>

#include <cmath>

namespace nearlight::core {
namespace {

/// A curve with RMSE = scale / √VPLs and `slowness` thousandths of a second per VPL.
Curve half_power(double scale, double slowness = 1.0) {
    Curve curve;
    for (const double vpls : {100.0, 400.0, 1600.0}) {
        curve.points.push_back({vpls, scale / std::sqrt(vpls), slowness * vpls / 1000.0});
    }
    return curve;
}

TEST(EqualRmse, ARivalTwiceAsWrongNeedsFourTimesTheVpls) {
    const auto groups = equal_rmse(std::vector{half_power(1.0), half_power(2.0, 0.5)}, 0);
    ASSERT_EQ(groups.size(), 3u);
    EXPECT_DOUBLE_EQ(groups[0].rmse, 0.1);  // groups go from the largest RMSE to the smallest
    EXPECT_DOUBLE_EQ(groups[2].rmse, 0.025);
    const EqualRmseRow& own = groups[0].rows[0];
    EXPECT_EQ(own.reach, Reach::measured);
    EXPECT_EQ(own.vpls, 100.0);
    EXPECT_EQ(own.vpls_ratio, 1.0);
    const EqualRmseRow& rival = groups[0].rows[1];
    EXPECT_EQ(rival.curve, 1u);
    EXPECT_EQ(rival.reach, Reach::fitted);
    EXPECT_NEAR(rival.vpls, 400.0, 1e-6);
    EXPECT_NEAR(rival.seconds, 0.2, 1e-9);
    EXPECT_NEAR(rival.vpls_ratio, 4.0, 1e-9);
    EXPECT_NEAR(rival.time_ratio, 2.0, 1e-9);
}

TEST(EqualRmse, BeyondTwiceTheMeasuredRangeItIsExtrapolated) {
    const auto groups =
        equal_rmse(std::vector{half_power(1.0), half_power(2.0), half_power(0.25), half_power(1.4)}, 0);
    EXPECT_EQ(groups[1].rows[1].reach, Reach::fitted);        // 1600
    EXPECT_EQ(groups[2].rows[1].reach, Reach::extrapolated);  // 6400
    EXPECT_NEAR(groups[2].rows[1].vpls, 6400.0, 1e-4);
    EXPECT_EQ(groups[0].rows[2].reach, Reach::extrapolated);  // 6.25 of at least 100
    EXPECT_EQ(groups[2].rows[3].reach, Reach::fitted);        // 3136: less than 3200
}

TEST(EqualRmse, WhatDoesNotImproveNeverArrives) {
    Curve flat = half_power(1.0);
    for (CurvePoint& point : flat.points) {
        point.rmse = 0.5;
    }
    Curve worsening = half_power(1.0);
    worsening.points.back().rmse = 3.0;
    for (const EqualRmse& group : equal_rmse(std::vector{half_power(1.0), flat, worsening}, 0)) {
        for (const std::size_t i : {1u, 2u}) {
            EXPECT_EQ(group.rows[i].reach, Reach::never);
            EXPECT_TRUE(std::isnan(group.rows[i].vpls));
            EXPECT_TRUE(std::isnan(group.rows[i].time_ratio));
        }
    }
}

TEST(EqualRmse, AHundredTimesWhatWasMeasuredIsOutOfReach) {
    const Curve near_enough = half_power(9.9);  // 98 times 1600
    const Curve hopeless = half_power(10.1);
    const auto groups = equal_rmse(std::vector{half_power(1.0), near_enough, hopeless}, 0);
    EXPECT_EQ(groups[2].rows[1].reach, Reach::extrapolated);
    EXPECT_EQ(groups[2].rows[2].reach, Reach::never);
}

TEST(EqualRmse, AFloorIsNeverPassed) {
    Curve curve = half_power(1.0);
    curve.floor = 0.04;
    const auto groups = equal_rmse(std::vector{half_power(1.0), curve}, 0);
    EXPECT_EQ(groups[1].rows[1].reach, Reach::fitted);  // 0.05
    EXPECT_EQ(groups[2].rows[1].reach, Reach::never);   // 0.025
}

TEST(EqualRmse, ABiasedMethodIsNotExtrapolatedToMoreVpls) {
    Curve biased = half_power(2.0);
    biased.biased = true;
    Curve good_but_biased = half_power(0.25);
    good_but_biased.biased = true;
    const auto groups = equal_rmse(std::vector{half_power(1.0), biased, good_but_biased}, 0);
    EXPECT_EQ(groups[0].rows[1].reach, Reach::fitted);
    EXPECT_EQ(groups[2].rows[1].reach, Reach::never);
    EXPECT_EQ(groups[0].rows[2].reach, Reach::extrapolated);  // to fewer
}

TEST(EqualRmse, OneCountIsNotEnoughToFit) {
    Curve single{.points = {{100, 0.1, 1.0}}};
    EXPECT_TRUE(equal_rmse(std::vector{single, half_power(1.0)}, 0).empty());
    const auto groups = equal_rmse(std::vector{half_power(1.0), single}, 0);
    ASSERT_EQ(groups.size(), 3u);
    EXPECT_EQ(groups[0].rows[1].reach, Reach::never);
}

TEST(EqualRmse, TheBaselineMayStandAnywhere) {
    const auto groups = equal_rmse(std::vector{half_power(2.0), half_power(1.0)}, 1);
    EXPECT_EQ(groups[0].rows[1].reach, Reach::measured);
    EXPECT_NEAR(groups[0].rows[0].vpls_ratio, 4.0, 1e-9);
}

TEST(EqualRmse, AnErrorOfZeroIsNoTarget) {
    Curve exact = half_power(1.0);
    exact.points.back().rmse = 0.0;
    EXPECT_EQ(equal_rmse(std::vector{exact}, 0).size(), 2u);
}

}  // namespace
}  // namespace nearlight::core
