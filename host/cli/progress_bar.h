// SPDX-License-Identifier: Apache-2.0
// A line that shows the progress of a long step.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <string_view>

#include "host/cli/command.h"

namespace nearlight::core {

/// A line such as "gathering 42 % [########............] 0:12 left", where the time left is known.
std::string progress_line(std::string_view label, double fraction,
                          std::optional<double> seconds_left = std::nullopt);

/// Estimates how long a piece of work still takes, from how far it is at what time. What comes before the
/// first news of it, and a little after, has its own pace: a scene is looked at, and drivers compile.
class TimeLeft {
  public:
    /// The work consists of so many equal steps. Each begins with a silence, which is as long as that of the
    /// latest step was. With 0 steps nobody knows how much work there is, and there is no estimate.
    explicit TimeLeft(int steps = 1) : steps_(steps) {}

    /// `fraction` of the work, 0 to 1, is done, `seconds` after it began; both ascend, unless the work is
    /// begun anew. Returns the seconds that are left, or nothing as long as that would be a guess. The first
    /// fraction may be that of whole steps which were done before.
    std::optional<double> at(double fraction, double seconds);

  private:
    /// A part of the work, and how long it took.
    struct Span {
        double fraction = 0;
        double seconds = 0;

        friend Span operator+(Span a, Span b) { return {a.fraction + b.fraction, a.seconds + b.seconds}; }
        friend Span operator-(Span a, Span b) { return {a.fraction - b.fraction, a.seconds - b.seconds}; }
    };
    /// What is done, and how much of it went by in silences that began steps.
    struct News {
        Span done;
        Span silent;
    };
    [[nodiscard]] double steps_begun(double fraction) const;
    [[nodiscard]] bool is_between_steps(double fraction) const;
    void note(double fraction, double seconds);

    int steps_;
    std::optional<News> first_{};
    std::optional<News> mark_{};  ///< where the pace is measured from, once that says enough
    News latest_{};
    Span silence_{};      ///< of the latest step, with the work before its first news
    bool works_ = false;  ///< whether that step has gone on beyond its silence
};

/// Shows a line on standard error if that is a terminal, updates it at most ten times a second, and removes
/// it at the end. Elsewhere it logs a debug message at each tenth. With --quiet it shows nothing. Only one
/// thread may use it.
class ProgressBar {
  public:
    /// As start().
    ProgressBar(std::string label, const GlobalOptions& global, int steps = 1);
    ~ProgressBar() { clear(); }
    ProgressBar(const ProgressBar&) = delete;
    ProgressBar& operator=(const ProgressBar&) = delete;

    /// Begins another piece of work with the name `label`, and restarts the clock. It consists of so many
    /// steps, see TimeLeft.
    void start(std::string label, int steps = 1);
    /// Shows that `fraction` of the work, 0 to 1, is done, and how long it still takes, which is estimated
    /// and at most `seconds_left`. It may be called at any rate.
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
    TimeLeft time_left_;
    int last_tenth_ = 0;
    bool visible_ = false;
};

}  // namespace nearlight::core
