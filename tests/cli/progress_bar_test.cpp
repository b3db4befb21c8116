// SPDX-License-Identifier: Apache-2.0
#include "host/cli/progress_bar.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "tests/cli/terminal.h"

namespace nearlight::core {
namespace {

TEST(ProgressBar, LineTellsLabelPartAndTimeLeft) {
    EXPECT_EQ(progress_line("gathering", 0.5, 75.0),
              "gathering  50 %  [############............]  1:15 left");
    EXPECT_EQ(progress_line("gathering", 0.75, 9.1),
              "gathering  75 %  [##################......]  0:10 left");
    EXPECT_EQ(progress_line("gathering", 1.0, 0.0), "gathering 100 %  [########################]  0:00 left");
    EXPECT_EQ(progress_line("tracing", 0.0), "tracing   0 %  [........................]");
}

TEST(ProgressBar, OddFractionsAreBounded) {
    EXPECT_EQ(progress_line("a", 7.0), progress_line("a", 1.0));
    EXPECT_EQ(progress_line("a", -7.0), progress_line("a", 0.0));
    EXPECT_EQ(progress_line("a", std::numeric_limits<double>::quiet_NaN()), progress_line("a", 0.0));
}

TEST(TimeLeft, SaysNothingBeforeAPaceIsMeasured) {
    TimeLeft left;
    EXPECT_FALSE(left.at(0.0, 100.0));
    EXPECT_FALSE(left.at(0.01, 105.0)) << "too little is done";
    EXPECT_TRUE(left.at(0.02, 110.0)) << "little, but in a long time";
    TimeLeft quick;
    quick.at(0.0, 1.0);
    EXPECT_FALSE(quick.at(0.3, 1.5)) << "in too short a time";
    EXPECT_NEAR(quick.at(0.5, 3.0).value(), 1.5 / 0.2 * 0.5, 1e-9);
    TimeLeft idle;
    idle.at(0.1, 1.0);
    EXPECT_FALSE(idle.at(0.1, 50.0)) << "without progress";
    EXPECT_FALSE(idle.at(std::numeric_limits<double>::quiet_NaN(), 51.0));
}

TEST(TimeLeft, LooksAtTheWorkOnlyAndNotAtWhatComesBefore) {
    TimeLeft left;
    left.at(0.0, 60.0);    // a minute of getting ready,
    left.at(0.001, 70.0);  // and ten seconds of compiling
    for (const double part : {0.2, 0.25, 0.5, 0.9, 1.0}) {
        EXPECT_NEAR(left.at(part, 70.0 + 100.0 * (part - 0.001)).value(), 100.0 * (1.0 - part), 1e-9) << part;
    }
}

/// Passes that look and place VPLs for 5 s each before they gather for 10 s.
TEST(TimeLeft, KnowsThatEachStepBeginsInSilence) {
    constexpr int kSteps = 4;
    TimeLeft left(kSteps);
    const auto seconds_at = [](double part) {
        const double step = std::min(std::floor(part * kSteps), kSteps - 1.0);
        return 5.0 * (step + 1) + 10.0 * part * kSteps;
    };
    for (const double part : {0.0, 0.01, 0.06, 0.1, 0.2, 0.24, 0.26, 0.4, 0.6, 0.76, 0.9, 1.0}) {
        const std::optional<double> now = left.at(part, seconds_at(part));
        if (part >= 0.1) {
            ASSERT_TRUE(now.has_value()) << part;
            EXPECT_NEAR(*now, seconds_at(1.0) - seconds_at(part), 1e-9) << part;
        }
    }
}

/// Steps as render has them: the end of a step and the beginning of the work of the next are the same
/// fraction.
struct Step {
    double silence, work;  // seconds
};

/// Tells `left` of the steps in tenths, and compares what it says of them with the truth from the step `sure`
/// on.
void expect_times(TimeLeft& left, const std::vector<Step>& steps, std::size_t done_before, std::size_t sure) {
    double all = 0;
    for (const Step& step : steps) {
        all += step.silence + step.work;
    }
    const double count = static_cast<double>(done_before + steps.size());
    double seconds = 0;
    for (std::size_t i = 0; i < steps.size(); ++i) {
        seconds += steps[i].silence;
        for (int tenth = 0; tenth <= 10; ++tenth) {
            const double begun = static_cast<double>(done_before + i);
            const std::optional<double> now =
                left.at((begun + tenth / 10.0) / count, seconds + steps[i].work * tenth / 10.0);
            if (i >= sure && tenth > 5) {
                ASSERT_TRUE(now.has_value()) << i << " " << tenth;
                const double truth = all - seconds - steps[i].work * tenth / 10.0;
                EXPECT_NEAR(*now, truth, 0.1 * truth + 0.5) << i << " " << tenth;
            }
        }
        seconds += steps[i].work;
    }
}

TEST(TimeLeft, TakesTheSilenceOfTheLatestStep) {
    TimeLeft left(5);
    expect_times(left, {{30, 4}, {2, 4}, {2, 4}, {2, 4}, {2, 4}}, 0, 1);
}

/// The first news is then the fraction that earlier runs have done.
TEST(TimeLeft, GoesOnFromWholeStepsOfEarlierRuns) {
    TimeLeft left(8);
    expect_times(left, {{5, 20}, {5, 20}, {5, 20}, {5, 20}}, 4, 0);
}

/// As a first pass is, if it does not fit in the time.
TEST(TimeLeft, ForgetsWorkThatWasBegunAnew) {
    TimeLeft left;
    left.at(0.9, 1.0);
    left.at(1.0, 2.0);
    EXPECT_FALSE(left.at(0.1, 3.0));
    for (const double part : {0.2, 0.4, 0.6, 1.0}) {
        EXPECT_NEAR(left.at(part, 3.0 + 100.0 * (part - 0.1)).value(), 100.0 * (1.0 - part), 1e-9) << part;
    }
}

TEST(TimeLeft, SaysNothingWhereTheAmountOfWorkIsUnknown) {
    TimeLeft left(0);
    left.at(0.0, 1.0);
    EXPECT_FALSE(left.at(0.5, 100.0));
}

TEST(ProgressBar, OnTheTerminalItIsDrawnSeldomAndCleared) {
    const test::Terminal terminal;
    if (!test::Terminal::works()) {
        GTEST_SKIP() << "no pseudo-terminal here";
    }
    {
        ProgressBar bar("gathering", GlobalOptions{});
        for (int i = 0; i < 1000; ++i) {
            bar.update(0.25);
        }
    }
    const std::string text = terminal.read_all();
    EXPECT_TRUE(text.starts_with("\r" + progress_line("gathering", 0.25) + "\033[K")) << text;
    EXPECT_TRUE(text.ends_with("\033[K\r\033[K")) << text;
    // A thousand updates take far less than a tenth of a second, after which a line is drawn again. On a busy
    // machine they may take longer, but not a hundred times as long.
    EXPECT_LT(std::count(text.begin(), text.end(), '\r'), 100);
}

TEST(ProgressBar, QuietShowsNothingOnTheTerminal) {
    const test::Terminal terminal;
    GlobalOptions global;
    global.quiet = true;
    ProgressBar bar("gathering", global);
    bar.update(0.5);
    EXPECT_EQ(terminal.read_all(), "");
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
}  // namespace nearlight::core
