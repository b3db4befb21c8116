// SPDX-License-Identifier: Apache-2.0
#include "host/cli/progress_bar.h"

#include <gtest/gtest.h>

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
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

/// A terminal in place of standard error, as long as it lives.
class Terminal {
  public:
    Terminal() : terminal_(posix_openpt(O_RDWR | O_NOCTTY)), old_errors_(dup(STDERR_FILENO)) {
        if (terminal_ >= 0 && grantpt(terminal_) == 0 && unlockpt(terminal_) == 0) {
            const int other_end = open(ptsname(terminal_), O_RDWR | O_NOCTTY);
            dup2(other_end, STDERR_FILENO);
            close(other_end);
        }
    }
    ~Terminal() {
        dup2(old_errors_, STDERR_FILENO);
        close(old_errors_);
        close(terminal_);
    }
    Terminal(const Terminal&) = delete;
    Terminal& operator=(const Terminal&) = delete;

    [[nodiscard]] static bool works() { return isatty(STDERR_FILENO) == 1; }
    /// What was written, if anything was.
    [[nodiscard]] std::string read_all() const {
        fcntl(terminal_, F_SETFL, O_NONBLOCK);
        std::array<char, 4096> buffer{};
        const ssize_t count = read(terminal_, buffer.data(), buffer.size());
        return {buffer.data(), static_cast<std::size_t>(std::max<ssize_t>(count, 0))};
    }

  private:
    int terminal_;
    int old_errors_;
};

TEST(ProgressBar, OnTheTerminalItIsDrawnSeldomAndCleared) {
    const Terminal terminal;
    if (!Terminal::works()) {
        GTEST_SKIP() << "no pseudo-terminal here";
    }
    {
        ProgressBar bar("gathering", GlobalOptions{});
        for (int i = 0; i < 1000; ++i) {
            bar.update(0.25);
        }
    }
    const std::string text = terminal.read_all();
    EXPECT_EQ(text, "\r" + progress_line("gathering", 0.25, 0.0) + "\033[K\r\033[K");
}

TEST(ProgressBar, QuietShowsNothingOnTheTerminal) {
    const Terminal terminal;
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
}  // namespace nearlight
