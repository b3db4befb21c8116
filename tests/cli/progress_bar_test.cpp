// SPDX-License-Identifier: Apache-2.0
#include "host/cli/progress_bar.h"

#include <gtest/gtest.h>

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <limits>

namespace nearlight::core {
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

TEST(ProgressBar, TakesTheCallersWordForTheTimeLeft) {
    EXPECT_EQ(progress_line("cells", 0.5, 0.01, 61.0), "cells  50 %  [############............]  1:01 left");
    EXPECT_EQ(progress_line("cells", 0.0, 0.0, 3.0), "cells   0 %  [........................]  0:03 left");
}

TEST(ProgressBar, OddFractionsAreBounded) {
    EXPECT_EQ(progress_line("a", 7.0, 0.0), progress_line("a", 1.0, 0.0));
    EXPECT_EQ(progress_line("a", -7.0, 0.0), progress_line("a", 0.0, 0.0));
    EXPECT_EQ(progress_line("a", std::numeric_limits<double>::quiet_NaN(), 0.0),
              progress_line("a", 0.0, 0.0));
}

/// Replaces standard error by a terminal during its lifetime.
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
    /// The text that was written. The operating system delivers it in pieces, so a long silence means its
    /// end.
    [[nodiscard]] std::string read_all() const {
        std::string text;
        pollfd ready{.fd = terminal_, .events = POLLIN, .revents = 0};
        while (poll(&ready, 1, 200) == 1 && (ready.revents & POLLIN) != 0) {
            std::array<char, 4096> buffer{};
            const ssize_t count = read(terminal_, buffer.data(), buffer.size());
            text.append(buffer.data(), static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
        }
        return text;
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
    EXPECT_TRUE(text.starts_with("\r" + progress_line("gathering", 0.25, 0.0) + "\033[K")) << text;
    EXPECT_TRUE(text.ends_with("\033[K\r\033[K")) << text;
    // A thousand updates take far less than a tenth of a second, after which a line is drawn again. On a busy
    // machine they may take longer, but not a hundred times as long.
    EXPECT_LT(std::count(text.begin(), text.end(), '\r'), 100);
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
}  // namespace nearlight::core
