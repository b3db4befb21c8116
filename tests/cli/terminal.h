// SPDX-License-Identifier: Apache-2.0
// A pseudo-terminal in the place of standard error.
#pragma once

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <string>

namespace nearlight::core::test {

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

}  // namespace nearlight::core::test
