// SPDX-License-Identifier: Apache-2.0
#include "host/cli/progress_bar.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <utility>

#include "host/cli/log.h"

namespace nearlight::core {
namespace {

constexpr int kBarWidth = 24;
constexpr std::chrono::milliseconds kUpdateInterval{100};
/// After this much of the work or of time, drivers have compiled what they compile when kernels first run.
constexpr double kIgnoredPart = 0.05;
constexpr double kIgnoredSeconds = 10.0;
/// When this much more of the work is done, the pace is measured from there on. Before, it is measured from
/// the first news on, because work comes in pieces whose halves may differ.
constexpr double kSurePart = 0.15;
/// A pace that was measured over this time and this much of the work, or over ten times as long, is no guess.
constexpr double kMeasuredSeconds = 1.0;
constexpr double kMeasuredPart = 0.05;
/// Work whose fraction falls by more than this was begun anew, with less to do.
constexpr double kBegunAnew = 0.1;
/// Fractions of the work have smaller errors than this, as numbers of steps.
constexpr double kRounding = 1e-6;

std::string minutes_and_seconds(double seconds) {
    const auto whole = static_cast<long>(std::ceil(seconds));
    std::array<char, 48> text{};
    std::snprintf(text.data(), text.size(), "%ld:%02ld", whole / 60, whole % 60);
    return text.data();
}

double bounded(double fraction) {
    return std::isfinite(fraction) ? std::clamp(fraction, 0.0, 1.0) : 0.0;
}

}  // namespace

double TimeLeft::steps_begun(double fraction) const {
    return std::clamp(std::ceil(fraction * steps_ - kRounding), 1.0, 1.0 * steps_);
}

/// Whether a step has just ended, and the next one may be silent.
bool TimeLeft::is_between_steps(double fraction) const {
    const double steps = fraction * steps_;
    return steps > 0.5 && std::abs(steps - std::round(steps)) < kRounding;
}

void TimeLeft::note(double fraction, double seconds) {
    if (!first_) {
        silence_ = {fraction - std::floor(fraction * steps_ + kRounding) / steps_, seconds};
        first_ = latest_ = {{fraction, seconds}, {}};
        return;
    }
    const double before = latest_.done.fraction;
    if (is_between_steps(before) || steps_begun(fraction) > steps_begun(before)) {
        const Span gap{fraction - before, seconds - latest_.done.seconds};
        silence_ = works_ ? gap : silence_ + gap;
        latest_.silent = latest_.silent + gap;
        works_ = false;
    }
    works_ = works_ || !is_between_steps(fraction);
    latest_.done = {fraction, seconds};
}

std::optional<double> TimeLeft::at(double fraction, double seconds) {
    if (steps_ == 0) {
        return std::nullopt;
    }
    fraction = bounded(fraction);
    if (first_ && fraction < latest_.done.fraction - kBegunAnew) {
        *this = TimeLeft(steps_);
    }
    note(fraction, seconds);
    const Span& done = latest_.done;
    if (!mark_ && (done.fraction >= first_->done.fraction + kIgnoredPart ||
                   done.seconds >= first_->done.seconds + kIgnoredSeconds)) {
        mark_ = latest_;
    }
    const bool is_sure = mark_ && done.fraction >= mark_->done.fraction + kSurePart;
    const News& from = is_sure ? *mark_ : *first_;
    const Span worked = done - from.done - (latest_.silent - from.silent);
    const double needed = worked.fraction >= kMeasuredPart ? kMeasuredSeconds : 10.0 * kMeasuredSeconds;
    if (worked.fraction <= 0.0 || worked.seconds < needed) {
        return std::nullopt;
    }
    const double pace = worked.seconds / worked.fraction;
    const double silence = std::max(0.0, silence_.seconds - pace * silence_.fraction);
    return pace * (1.0 - done.fraction) + silence * (steps_ - steps_begun(done.fraction));
}

std::string progress_line(std::string_view label, double fraction, std::optional<double> seconds_left) {
    const double done = bounded(fraction);
    std::string bar(kBarWidth, '.');
    std::fill_n(bar.begin(), static_cast<int>(done * kBarWidth), '#');
    std::string percent = std::to_string(static_cast<int>(done * 100.0));
    percent.insert(0, 3 - percent.size(), ' ');
    std::string line = std::string(label) + " " + percent + " %  [" + bar + "]";
    if (seconds_left) {
        line += "  " + minutes_and_seconds(*seconds_left) + " left";
    }
    return line;
}

ProgressBar::ProgressBar(std::string label, const GlobalOptions& global, int steps)
    : style_(global.quiet            ? Style::none
             : isatty(STDERR_FILENO) ? Style::line
                                     : Style::messages) {
    start(std::move(label), steps);
}

void ProgressBar::start(std::string label, int steps) {
    clear();
    time_left_ = TimeLeft(steps);
    label_ = std::move(label);
    start_ = Clock::now();
    last_update_ = start_ - kUpdateInterval;
    last_tenth_ = 0;
}

void ProgressBar::update(double fraction, std::optional<double> seconds_left) {
    if (style_ == Style::line) {
        const auto now = Clock::now();
        const auto estimate = time_left_.at(fraction, std::chrono::duration<double>(now - start_).count());
        if (now - last_update_ >= kUpdateInterval) {
            last_update_ = now;
            visible_ = true;
            const std::optional<double> left = estimate && seconds_left ? std::min(*estimate, *seconds_left)
                                               : estimate               ? estimate
                                                                        : seconds_left;
            const std::string line = progress_line(label_, fraction, left);
            std::fprintf(stderr, "\r%s\033[K", line.c_str());
            std::fflush(stderr);
        }
    } else if (style_ == Style::messages && static_cast<int>(fraction * 10.0) > last_tenth_) {
        last_tenth_ = static_cast<int>(fraction * 10.0);
        spdlog::debug("{}: {} %", label_, last_tenth_ * 10);
    }
}

void ProgressBar::clear() {
    if (visible_) {
        visible_ = false;
        std::fputs("\r\033[K", stderr);
        std::fflush(stderr);
    }
}

}  // namespace nearlight::core
