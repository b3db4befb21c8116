// SPDX-License-Identifier: Apache-2.0
#include "viewer/pass_mean.h"

#include <gtest/gtest.h>

namespace nearlight::viewer {
namespace {

Image pass(float light, float depth) {
    return {.width = 1,
            .height = 1,
            .channels = {"R", "direct.R", "depth.Z"},
            .values = {light, 2 * light, depth}};
}

TEST(PassMean, AveragesLightAndKeepsTheFirstSurfaces) {
    PassMean mean;
    mean.add(pass(1, 5), 1);
    mean.add(pass(2, 6), 1);
    mean.add(pass(6, 7), 2);
    EXPECT_EQ(mean.samples(), 4u);
    EXPECT_FLOAT_EQ(mean.image().values[0], (1 + 2 + 6 * 2) / 4.0f);
    EXPECT_FLOAT_EQ(mean.image().values[1], 2 * (1 + 2 + 6 * 2) / 4.0f);
    EXPECT_EQ(mean.image().values[2], 5.0f);
}

TEST(PassMean, ForgetsWhatWasCleared) {
    PassMean mean;
    mean.add(pass(1, 5), 1);
    mean.clear();
    mean.add(pass(3, 6), 1);
    EXPECT_EQ(mean.image().values[0], 3.0f);
    EXPECT_EQ(mean.image().values[2], 6.0f);
}

}  // namespace
}  // namespace nearlight::viewer
