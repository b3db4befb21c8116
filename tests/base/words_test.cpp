// SPDX-License-Identifier: Apache-2.0
#include "host/base/words.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace nearlight::core {
namespace {

using testing::ElementsAre;

TEST(Words, AreSplitAtEachSeparator) {
    EXPECT_THAT(split("a,bc,,d", ','), ElementsAre("a", "bc", "", "d"));
    EXPECT_THAT(split("", ','), ElementsAre(""));
    EXPECT_THAT(split(",", ','), ElementsAre("", ""));
    EXPECT_THAT(split("a,b", ' '), ElementsAre("a,b"));
}

TEST(Words, AreJoined) {
    EXPECT_EQ(joined(std::vector<std::string>{}, ", "), "");
    EXPECT_EQ(joined(std::vector<std::string>{"", "a", ""}, ", "), ", a, ");
    EXPECT_EQ(joined(std::vector<int>{3, 4}, "-", [](int number) { return std::to_string(number); }), "3-4");
}

}  // namespace
}  // namespace nearlight::core
