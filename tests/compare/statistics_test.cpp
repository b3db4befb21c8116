// SPDX-License-Identifier: Apache-2.0
#include "host/compare/statistics.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "host/base/median.h"

namespace nearlight::core {
namespace {

TEST(Statistics, AnIntervalFollowsFromTheSpread) {
    const Interval interval = mean_interval(std::array{1.0, 2.0, 3.0, 4.0});
    EXPECT_DOUBLE_EQ(interval.mean, 2.5);
    EXPECT_NEAR(interval.half_width, 3.18245 * std::sqrt(5.0 / 3.0 / 4.0), 1e-4);
}

TEST(Statistics, OneValueHasNoIntervalAndNoneNoMean) {
    EXPECT_DOUBLE_EQ(mean_interval(std::array{7.0}).mean, 7.0);
    EXPECT_TRUE(std::isnan(mean_interval(std::array{7.0}).half_width));
    EXPECT_TRUE(std::isnan(mean_interval({}).mean));
}

TEST(Statistics, TheMedianIsInTheMiddle) {
    EXPECT_EQ(median({9.0, 1.0, 2.0}), 2.0);
    EXPECT_EQ(median({9.0, 1.0, 2.0, 4.0}), 3.0);
    EXPECT_TRUE(std::isnan(median({})));
}

TEST(Statistics, RmseIsTheRootOfTheMeanOfSquares) {
    const RmseEstimate even = rmse_estimate(std::array{4.0, 4.0});
    EXPECT_DOUBLE_EQ(even.value, 2.0);
    EXPECT_DOUBLE_EQ(even.half_width, 0.0);
    const RmseEstimate spread = rmse_estimate(std::array{1.0, 9.0});
    EXPECT_DOUBLE_EQ(spread.value, std::sqrt(5.0));
    EXPECT_NEAR(spread.half_width, 12.7062 * 4.0 / (2.0 * std::sqrt(5.0)), 1e-3);
    EXPECT_EQ(spread.low, 0.0);
    EXPECT_NEAR(spread.high, std::sqrt(5.0 + 12.7062 * 4.0), 1e-3);
}

TEST(Statistics, AnErrorBelowTheNoiseOfTheReferenceIsZero) {
    const RmseEstimate estimate = rmse_estimate(std::array{-1.0, 0.5});
    EXPECT_EQ(estimate.value, 0.0);
    EXPECT_TRUE(std::isnan(estimate.half_width));
    EXPECT_GT(estimate.high, 0.0);
}

TEST(Statistics, APowerLawIsFoundExactly) {
    const std::vector<double> x{10, 20, 80, 500};
    std::vector<double> y;
    for (const double value : x) {
        y.push_back(3.0 * std::pow(value, -0.6));
    }
    const auto law = fit_power_law(x, y);
    ASSERT_TRUE(law);
    EXPECT_NEAR(law->slope, -0.6, 1e-12);
    EXPECT_NEAR(law->at(100.0), 3.0 * std::pow(100.0, -0.6), 1e-12);
    EXPECT_NEAR(law->inverse(law->at(42.0)), 42.0, 1e-9);
}

TEST(Statistics, AFitThroughScatteredPointsIsTheOneOfLeastSquares) {
    // The natural logarithms x = 0, 1, 2 and y = 0, 2, 1 have slope 1/2 and intercept 1/2.
    const auto law = fit_power_law(std::array{1.0, std::exp(1.0), std::exp(2.0)},
                                   std::array{1.0, std::exp(2.0), std::exp(1.0)});
    ASSERT_TRUE(law);
    EXPECT_NEAR(law->slope, 0.5, 1e-12);
    EXPECT_NEAR(law->intercept, 0.5, 1e-12);
}

TEST(Statistics, AFitNeedsTwoDifferentPointsWithLogarithms) {
    EXPECT_FALSE(fit_power_law(std::array{5.0, 5.0}, std::array{1.0, 2.0}));
    EXPECT_FALSE(fit_power_law(std::array{5.0, 9.0}, std::array{1.0, 0.0}));
    EXPECT_FALSE(fit_power_law(std::array{5.0, 9.0}, std::array{1.0, std::nan("")}));
    EXPECT_TRUE(fit_power_law(std::array{5.0, 9.0, 10.0}, std::array{1.0, 0.0, 3.0}));
}

}  // namespace
}  // namespace nearlight::core
