// SPDX-License-Identifier: Apache-2.0
#include "host/base/suggestion.h"

#include <gtest/gtest.h>

#include <vector>

namespace nearlight::core {
namespace {

TEST(Suggestion, EditDistance) {
    EXPECT_EQ(edit_distance("", ""), 0u);
    EXPECT_EQ(edit_distance("", "abc"), 3u);
    EXPECT_EQ(edit_distance("abc", ""), 3u);
    EXPECT_EQ(edit_distance("render", "render"), 0u);
    EXPECT_EQ(edit_distance("rendr", "render"), 1u);
    EXPECT_EQ(edit_distance("redner", "render"), 1u);
    EXPECT_EQ(edit_distance("kitten", "sitting"), 3u);
}

TEST(Suggestion, NearestWord) {
    const std::vector<std::string> words{"--vpls", "--passes", "--seed", "--spp"};
    EXPECT_EQ(nearest_word("--vlps", words), "--vpls");
    EXPECT_EQ(nearest_word("--pases", words), "--passes");
    EXPECT_EQ(nearest_word("--frobnicate", words), "");
    EXPECT_EQ(nearest_word("--seed", {}), "");
    const std::vector<std::string> near{"--up", "--spp", "--fps", "--spq"};
    EXPECT_EQ(nearest_word("--sp", near), "--spp");
    EXPECT_EQ(nearest_word("--spx", near), "--spp");
    const std::vector<std::string> far{"--version", "--environment", "--environment-scale"};
    EXPECT_EQ(nearest_word("--env", far), "--environment");
    EXPECT_EQ(nearest_word("-", far), "");
    const std::vector<std::string> options{"--up", "--output", "--time", "--tonemap"};
    EXPECT_EQ(nearest_word("--out", options), "--output");
    EXPECT_EQ(nearest_word("--tone", options), "--tonemap");
    EXPECT_EQ(nearest_word("--tme", options), "--time");
    EXPECT_EQ(nearest_word("--u", options), "--up");
    EXPECT_EQ(nearest_word("--x", options), "");
}

}  // namespace
}  // namespace nearlight::core
