// SPDX-License-Identifier: Apache-2.0
// A line that shows the progress of a long step.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <string_view>

#include "host/cli/command.h"

namespace nearlight::core {

/// A line such as "gathering 42 % [########............] 0:12 left". The time left is `seconds_left` if that
/// is given, otherwise an estimate from `fraction` and `elapsed_seconds`, which is absent at first.
std::string progress_line(std::string_view label, double fraction, double elapsed_seconds,
                          std::optional<double> seconds_left = std::nullopt);

/// Shows a line on standard error if that is a terminal, updates it at most ten times a second, and removes
/// it at the end. Elsewhere it logs a debug message at each tenth. With --quiet it shows nothing. Only one
/// thread may use it.
class ProgressBar {
  public:
    ProgressBar(std::string label, const GlobalOptions& global);
    ~ProgressBar() { clear(); }
    ProgressBar(const ProgressBar&) = delete;
    ProgressBar& operator=(const ProgressBar&) = delete;

    /// Begins another step with the name `label`, and restarts the clock.
    void start(std::string label);
    /// Shows that `fraction` of the step, 0 to 1, is done. It may be called at any rate.
    void update(double fraction, std::optional<double> seconds_left = std::nullopt);
    /// Removes the line, so that other text can be written. The next update() shows it again.
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
