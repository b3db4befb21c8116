// SPDX-License-Identifier: Apache-2.0
// One line that tells how far a long step is.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <string_view>

#include "host/cli/command.h"

namespace nearlight::core {

/// "gathering  42 %  [########............]  0:12 left"; the time appears once it can be told: from
/// `seconds_left` where the caller knows it, else from the fraction and the time that it took.
std::string progress_line(std::string_view label, double fraction, double elapsed_seconds,
                          std::optional<double> seconds_left = std::nullopt);

/// On standard error if that is a terminal, at most ten times a second, gone at the end. Elsewhere a debug
/// message at each tenth of the way. Nothing with --quiet. For one thread.
class ProgressBar {
  public:
    ProgressBar(std::string label, const GlobalOptions& global);
    ~ProgressBar() { clear(); }
    ProgressBar(const ProgressBar&) = delete;
    ProgressBar& operator=(const ProgressBar&) = delete;

    /// Another step begins: its name, and the clock starts anew.
    void start(std::string label);
    /// `fraction` of the step is done, 0 to 1. Cheap enough to call at any rate.
    void update(double fraction, std::optional<double> seconds_left = std::nullopt);
    /// Takes the line away, so that other text can be written; the next update() brings it back.
    void clear();

  private:
    using Clock = std::chrono::steady_clock;
    enum class Style { none, line, messages };

    std::string label_;
    Style style_;
    Clock::time_point start_;
    Clock::time_point last_update_;
    int last_tenth_ = 0;
    bool visible_ = false;
};

}  // namespace nearlight::core
