// SPDX-License-Identifier: Apache-2.0
#include "host/cli/progress_bar.h"

#include <gtest/gtest.h>

#include <limits>

namespace nearlight {
namespace {

TEST(ProgressBar, LineTellsLabelPartAndTimeLeft) {
    EXPECT_EQ(progress_line("gathering", 0.5, 75.0),
              "gathering  50 %  [############............]  1:15 left");
    EXPECT_EQ(progress_line("gathering", 0.75, 30.0),
              "gathering  75 %  [##################......]  0:10 left");
    EXPECT_EQ(progress_line("gathering", 1.0, 30.0),
              "gathering 100 %  [########################]  0:00 left");
}

TEST(ProgressBar, NoGuessAtTheBeginning) {
    EXPECT_EQ(progress_line("tracing", 0.0, 0.0), "tracing   0 %  [........................]");
    EXPECT_EQ(progress_line("tracing", 0.0, 100.0), "tracing   0 %  [........................]");
    EXPECT_EQ(progress_line("tracing", 0.5, 0.01), "tracing  50 %  [############............]");
}

TEST(ProgressBar, OddFractionsAreBounded) {
    EXPECT_EQ(progress_line("a", 7.0, 0.0), progress_line("a", 1.0, 0.0));
    EXPECT_EQ(progress_line("a", -7.0, 0.0), progress_line("a", 0.0, 0.0));
    EXPECT_EQ(progress_line("a", std::numeric_limits<double>::quiet_NaN(), 0.0),
              progress_line("a", 0.0, 0.0));
}

TEST(ProgressBar, OffTheTerminalNothingAppears) {
    testing::internal::CaptureStderr();
    {
        ProgressBar bar("gathering", GlobalOptions{});
        for (int i = 0; i <= 100; ++i) {
            bar.update(i / 100.0);
        }
    }
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

}  // namespace
}  // namespace nearlight
