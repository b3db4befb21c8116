// SPDX-License-Identifier: Apache-2.0
#include "host/compare/cost_model.h"
#include "tests/compare/methods.h"

#include <gtest/gtest.h>

#include <vector>

namespace nearlight::core {
namespace {

const Method kClose = default_method();

TEST(CostModel, KnowsNothingAtFirst) {
    EXPECT_FALSE(CostModel().seconds(std::vector{CellId{kClose, 100, 0}}));
}

TEST(CostModel, LearnsARateForEachMethod) {
    CostModel cost;
    cost.add({kClose, 100, 0}, 4.0);
    cost.add({kWalks, 100, 0}, 1.0);
    cost.add({kWalks, 300, 0}, 3.0);
    EXPECT_DOUBLE_EQ(*cost.seconds(std::vector{CellId{kClose, 200, 0}, CellId{kWalks, 50, 1}}), 8.5);
    EXPECT_DOUBLE_EQ(*cost.seconds({}), 0.0);
}

TEST(CostModel, TakesTheMeanOfAllForAMethodNotYetMeasured) {
    CostModel cost;
    cost.add({kClose, 100, 0}, 2.0);
    EXPECT_DOUBLE_EQ(*cost.seconds(std::vector{CellId{kWalks, 50, 0}}), 1.0);
}

TEST(CellOrder, IsSeedBySeedThenCountByCount) {
    CompareSettings settings;
    settings.methods = {kClose, kWalks};
    settings.vpl_counts = {10, 20};
    settings.seed_count = 2;
    settings.first_seed = 7;
    const std::vector<CellId> expected{{kClose, 10, 7}, {kWalks, 10, 7}, {kClose, 20, 7}, {kWalks, 20, 7},
                                       {kClose, 10, 8}, {kWalks, 10, 8}, {kClose, 20, 8}, {kWalks, 20, 8}};
    EXPECT_EQ(cells_of(settings), expected);
}

}  // namespace
}  // namespace nearlight::core
