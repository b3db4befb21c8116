// SPDX-License-Identifier: Apache-2.0
// A display that exists in memory only.
#pragma once

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <string>

namespace nearlight::core {

/// An X server of its own (Debian's package xvfb), until it is ended or destroyed.
class VirtualDisplay {
  public:
    VirtualDisplay() {
        int number_pipe[2];
        if (pipe(number_pipe) != 0) {
            return;
        }
        server_ = fork();
        if (server_ == 0) {
            // The server writes the number of a free display to the pipe when it is ready.
            const std::string fd = std::to_string(number_pipe[1]);
            const int nowhere = open("/dev/null", O_WRONLY);
            dup2(nowhere, STDERR_FILENO);
            execlp("Xvfb", "Xvfb", "-displayfd", fd.c_str(), "-screen", "0", "1280x1024x24", "-nolisten",
                   "tcp", static_cast<char*>(nullptr));
            _exit(127);
        }
        close(number_pipe[1]);
        char digit = 0;
        while (read(number_pipe[0], &digit, 1) == 1 && digit != '\n') {
            number_.push_back(digit);
        }
        close(number_pipe[0]);
    }
    ~VirtualDisplay() { end(); }
    VirtualDisplay(const VirtualDisplay&) = delete;
    VirtualDisplay& operator=(const VirtualDisplay&) = delete;

    /// False if there is no Xvfb.
    [[nodiscard]] bool is_there() const { return !number_.empty(); }
    /// The words of a shell that run a program on this display. Mesa is told that there is no GPU, because it
    /// else looks for one and complains about its absence on standard error.
    [[nodiscard]] std::string prefix() const {
        return "env -u WAYLAND_DISPLAY LIBGL_ALWAYS_SOFTWARE=1 DISPLAY=:" + number_;
    }
    void end() {
        if (server_ > 0) {
            kill(server_, SIGKILL);
            waitpid(server_, nullptr, 0);
            server_ = -1;
        }
    }

  private:
    pid_t server_ = -1;
    std::string number_;
};

}  // namespace nearlight::core
