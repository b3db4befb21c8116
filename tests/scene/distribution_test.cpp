// SPDX-License-Identifier: Apache-2.0
#include "host/scene/distribution.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "host/base/random.h"
#include "tests/support/error_matchers.h"

namespace nearlight::core {
namespace {

std::vector<double> steps(const std::vector<float>& cdf) {
    std::vector<double> result;
    float before = 0;
    for (const float value : cdf) {
        result.push_back(value - before);
        before = value;
    }
    return result;
}

TEST(Distribution, IsInProportionToTheWeights) {
    const std::vector<double> weights{1, 0, 3, 4};
    const auto p = steps(cumulative_distribution(weights));
    EXPECT_NEAR(p[0], 0.125, 1e-6);
    EXPECT_EQ(p[1], 0.0);
    EXPECT_NEAR(p[2], 0.375, 1e-6);
    EXPECT_NEAR(p[3], 0.5, 1e-6);
}

TEST(Distribution, EndsAtExactlyOneAndNeverFallsInALargeTable) {
    Pcg32 random(1);
    std::vector<double> weights(1000000);
    for (double& weight : weights) {
        weight = std::pow(random.uniform(), 20.0f);  // many are tiny
    }
    const std::vector<float> cdf = cumulative_distribution(weights);
    EXPECT_EQ(cdf.back(), 1.0f);
    float before = 0;
    for (std::size_t i = 0; i < cdf.size(); ++i) {
        if (weights[i] > 0) {
            ASSERT_GE(cdf[i] - before, 0x1p-24f) << "a positive weight was lost";
        } else {
            ASSERT_EQ(cdf[i], before);
        }
        ASSERT_EQ(std::fmod(cdf[i] * 0x1p24, 1.0), 0.0) << "not a whole quantum";
        before = cdf[i];
    }
}

TEST(Distribution, SelectsWithExactlyTheStatedProbability) {
    const std::vector<float> cdf = cumulative_distribution(std::vector<double>{1e-12, 5, 0, 2, 1e-9});
    std::vector<int> counts(cdf.size());
    for (int i = 0; i < 1 << 24; ++i) {  // every number that Pcg32::uniform() can return
        ++counts[select(cdf, static_cast<float>(i) * 0x1p-24f)];
    }
    const auto p = steps(cdf);
    for (std::size_t i = 0; i < cdf.size(); ++i) {
        EXPECT_EQ(counts[i], p[i] * 0x1p24);
    }
    EXPECT_EQ(counts[2], 0);
    EXPECT_GT(counts[0], 0);
}

TEST(Distribution, NothingButZerosIsUniform) {
    const auto p = steps(cumulative_distribution(std::vector<double>{0, -1, std::nan(""), 0}));
    for (const double step : p) {
        EXPECT_EQ(step, 0.25);
    }
    EXPECT_TRUE(cumulative_distribution({}).empty());
}

TEST(Distribution, MoreWeightsThanItTellsApartAreRefused) {
    const Error error =
        test::error_of([] { (void)cumulative_distribution(std::vector<double>((1u << 23u) + 1, 1.0)); });
    EXPECT_EQ(error.kind(), ErrorKind::out_of_memory);
    EXPECT_TRUE(test::mentions(error, "8388609 sources of light"));
}

}  // namespace
}  // namespace nearlight::core
