// SPDX-License-Identifier: Apache-2.0
#include "host/samplers/resampling.h"

#include <gtest/gtest.h>

#include <limits>
#include <numeric>

#include "host/base/random.h"

namespace nearlight::core {
namespace {

std::vector<float> random_weights(std::size_t count) {
    Pcg32 random(3);
    std::vector<float> weights(count);
    for (float& weight : weights) {
        weight = random.uniform() * random.uniform();
    }
    return weights;
}

TEST(Resampling, KeepsTheExpectationOfAnySum) {
    std::vector<float> weights = random_weights(200);
    weights[17] = 40;  // chosen for certain
    // Equidistant shifts integrate the piecewise constant choice almost exactly.
    constexpr int kShifts = 4000;
    for (const std::size_t wanted : {1, 30, 150}) {
        std::vector<double> mean_factor(weights.size());
        std::vector<int> chosen(weights.size());
        for (int k = 0; k < kShifts; ++k) {
            const Choice choice = resample(weights, wanted, (k + 0.5) / kShifts);
            EXPECT_NEAR(double(choice.indices.size()), double(wanted), 1);
            for (std::size_t i = 0; i < choice.indices.size(); ++i) {
                mean_factor[choice.indices[i]] += choice.factors[i] / double{kShifts};
                ++chosen[choice.indices[i]];
            }
        }
        for (std::size_t i = 0; i < weights.size(); ++i) {
            // One shift more or less changes the mean by the factor divided by the number of shifts.
            const double factor = chosen[i] > 0 ? mean_factor[i] * kShifts / chosen[i] : kShifts;
            EXPECT_NEAR(mean_factor[i], 1.0, 2.0 * factor / kShifts) << i << " of " << wanted;
        }
    }
}

TEST(Resampling, ChoosesAsManyAsWanted) {
    const std::vector<float> even(1000, 0.25f);
    for (const double shift : {0.0, 0.3, 0.999}) {
        const Choice choice = resample(even, 100, shift);
        EXPECT_NEAR(static_cast<double>(choice.indices.size()), 100, 1);
        for (const float factor : choice.factors) {
            EXPECT_FLOAT_EQ(factor, 10.0f);
        }
    }
}

TEST(Resampling, TakesTheHeaviestForCertainAndAllWhereThereAreFew) {
    const std::vector<float> uneven{1, 98, 1, 1, 1};
    for (const double shift : {0.0, 0.4, 0.9}) {
        const Choice choice = resample(uneven, 2, shift);
        ASSERT_EQ(choice.indices.size(), 2u);
        const std::size_t heavy = choice.indices[0] == 1 ? 0 : 1;
        EXPECT_EQ(choice.indices[heavy], 1u);
        EXPECT_EQ(choice.factors[heavy], 1.0f);
        EXPECT_FLOAT_EQ(choice.factors[1 - heavy], 4.0f);
    }
    const Choice all = resample(uneven, 5, 0.7);
    EXPECT_EQ(all.indices, (std::vector<uint>{0, 1, 2, 3, 4}));
    EXPECT_EQ(all.factors, std::vector<float>(5, 1.0f));
    EXPECT_EQ(resample(uneven, 100, 0.7).indices.size(), 5u);
}

TEST(Resampling, NeverChoosesWhatHasNoWeight) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const float infinity = std::numeric_limits<float>::infinity();
    const std::vector<float> weights{0, nan, 2, -1, infinity, 2};
    for (const double shift : {0.0, 0.25, 0.75}) {
        for (const uint index : resample(weights, 4, shift).indices) {
            EXPECT_TRUE(index == 2 || index == 5) << index;
        }
    }
    EXPECT_TRUE(resample(std::vector<float>{0, 0}, 4, 0.5).indices.empty());
    EXPECT_TRUE(resample(std::vector<float>{}, 4, 0.5).indices.empty());
    EXPECT_TRUE(resample(std::vector<float>{1}, 0, 0.5).indices.empty());
}

TEST(Resampling, ScalesThePowerOfTheChosen) {
    std::vector<Vpl> candidates(4);
    for (uint i = 0; i < 4; ++i) {
        candidates[i].power = {float(i), 2.0f * float(i), 1};
        candidates[i].depth = i;
    }
    const std::vector<Vpl> chosen = take({.indices = {1, 3}, .factors = {2, 0.5f}}, candidates);
    ASSERT_EQ(chosen.size(), 2u);
    EXPECT_EQ(chosen[0].depth, 1u);
    EXPECT_EQ(chosen[0].power.y, 4.0f);
    EXPECT_EQ(chosen[1].power.x, 1.5f);
}

}  // namespace
}  // namespace nearlight::core
