// SPDX-License-Identifier: Apache-2.0
#include "host/base/thread_limit.h"

#include <gtest/gtest.h>

namespace nearlight::core {
namespace {

TEST(ThreadLimit, HoldsWhileItLives) {
    const int before = allowed_threads();
    {
        const ThreadLimit one(1);
        EXPECT_EQ(allowed_threads(), 1);
        const ThreadLimit more(7);
        EXPECT_EQ(allowed_threads(), 1);
    }
    EXPECT_EQ(allowed_threads(), before);
    const ThreadLimit none(0);
    EXPECT_EQ(allowed_threads(), before);
}

}  // namespace
}  // namespace nearlight::core
