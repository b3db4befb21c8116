// SPDX-License-Identifier: Apache-2.0
#include "host/base/shell_word.h"

#include <gtest/gtest.h>

namespace nearlight::core {
namespace {

TEST(ShellWord, ShellsReadOddNamesAsTheyAre) {
    EXPECT_EQ(shell_word("plain/name-1.xml"), "plain/name-1.xml");
    EXPECT_EQ(shell_word("my room.xml"), "'my room.xml'");
    EXPECT_EQ(shell_word("it's"), "'it'\\''s'");
    EXPECT_EQ(shell_word("$HOME"), "'$HOME'");
    EXPECT_EQ(shell_word(""), "''");
}

}  // namespace
}  // namespace nearlight::core
