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
/// Minimum time after which an estimate of the time left is shown; earlier ones are too inaccurate.
constexpr double kFirstEstimateSeconds = 1.0;

std::string minutes_and_seconds(double seconds) {
    const auto whole = static_cast<long>(std::ceil(seconds));
    std::array<char, 48> text{};
    std::snprintf(text.data(), text.size(), "%ld:%02ld", whole / 60, whole % 60);
    return text.data();
}

}  // namespace

std::string progress_line(std::string_view label, double fraction, double elapsed_seconds,
                          std::optional<double> seconds_left) {
    const double done = std::isfinite(fraction) ? std::clamp(fraction, 0.0, 1.0) : 0.0;
    std::string bar(kBarWidth, '.');
    std::fill_n(bar.begin(), static_cast<int>(done * kBarWidth), '#');
    std::string percent = std::to_string(static_cast<int>(done * 100.0));
    percent.insert(0, 3 - percent.size(), ' ');
    std::string line = std::string(label) + " " + percent + " %  [" + bar + "]";
    if (seconds_left) {
        line += "  " + minutes_and_seconds(*seconds_left) + " left";
    } else if (done > 0.0 && elapsed_seconds >= kFirstEstimateSeconds) {
        line += "  " + minutes_and_seconds(elapsed_seconds * (1.0 - done) / done) + " left";
    }
    return line;
}

ProgressBar::ProgressBar(std::string label, const GlobalOptions& global)
    : style_(global.quiet            ? Style::none
             : isatty(STDERR_FILENO) ? Style::line
                                     : Style::messages) {
    start(std::move(label));
}

void ProgressBar::start(std::string label) {
    clear();
    label_ = std::move(label);
    start_ = Clock::now();
    last_update_ = start_ - kUpdateInterval;
    last_tenth_ = 0;
}

void ProgressBar::update(double fraction, std::optional<double> seconds_left) {
    if (style_ == Style::line) {
        const auto now = Clock::now();
        if (now - last_update_ >= kUpdateInterval) {
            last_update_ = now;
            visible_ = true;
            const double elapsed = std::chrono::duration<double>(now - start_).count();
            std::fprintf(stderr, "\r%s\033[K",
                         progress_line(label_, fraction, elapsed, seconds_left).c_str());
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
