// SPDX-License-Identifier: Apache-2.0
#include "host/session/pass_schedule.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "host/session/passes.h"

namespace nearlight::core {
namespace {

/// A pass is planned as if it had this many samples more: some passes take a little longer than those before,
/// and a short one takes longer for each of its samples.
constexpr double kPlannedExtra = 1.0;
/// The first pass is given up if it would exceed the time limit by more than this part of it. Giving up
/// costs the work so far.
constexpr double kToleratedPart = 0.1;
/// A pass is judged by this much of it, or by what it does in this much of the time limit: less says little
/// on a busy machine. The first kIgnoredPart of either is not looked at, because drivers compile kernels when
/// they first run.
constexpr double kJudgedPart = 0.15;
constexpr double kIgnoredPart = 0.03;
/// The last pass towards an error has more samples than the estimate says by this factor, and at least this
/// part of a full pass, so that it seldom takes a further one.
constexpr double kErrorReserve = 1.05;
constexpr double kMinErrorPart = 0.25;

uint max_passes_of(const RenderSettings& settings) {
    if (!settings.pass_samples.empty()) {
        return static_cast<uint>(settings.pass_samples.size());
    }
    if (settings.error) {
        return settings.passes.value_or(kMaxPassesToError);
    }
    return settings.passes.value_or(settings.seconds ? std::numeric_limits<uint>::max() : 1u);
}

}  // namespace

PassSchedule::PassSchedule(const RenderSettings& settings)
    : list_(settings.pass_samples),
      full_samples_(settings.gather.samples_per_pixel),
      min_samples_(min_pass_samples(settings.gather)),
      min_later_samples_(min_later_samples(settings.gather)),
      max_passes_(max_passes_of(settings)),
      seconds_(settings.seconds),
      target_(settings.error) {}

double PassSchedule::seconds_left() const {
    return seconds_ ? *seconds_ - watch_.seconds() : std::numeric_limits<double>::infinity();
}

double PassSchedule::fitting_samples() const {
    if (!seconds_) {
        return std::numeric_limits<double>::infinity();
    }
    if (!pace_.sample_seconds) {
        return seconds_left() > 0.0 ? full_samples_ : 0.0;
    }
    return (seconds_left() - next_vpl_seconds_) / *pace_.sample_seconds - kPlannedExtra;
}

double PassSchedule::needed_samples() const {
    return done_samples_ * std::pow(error_.value_or(0.0) / target_.value_or(1.0), 2.0);
}

bool PassSchedule::is_at_error() const {
    return error_ && target_ && *error_ <= *target_ &&
           (samples_.size() >= believed_passes_ || *error_ == 0.0);
}

/// The samples of the next pass, or 0 if there is to be none.
uint PassSchedule::next_samples() const {
    if (samples_.size() >= max_passes_ || is_at_error()) {
        return 0;
    }
    double samples = list_.empty() ? full_samples_ : list_[samples_.size()];
    if (error_ && target_) {
        const double missing = std::ceil(kErrorReserve * (needed_samples() - done_samples_));
        const double short_pass = std::max(kMinErrorPart * full_samples_, 1.0 * min_later_samples_);
        samples = std::clamp(missing, std::min(short_pass, samples), samples);
    }
    const double fewest = std::min<double>(samples, samples_.empty() ? min_samples_ : min_later_samples_);
    samples = std::min(samples, fitting_samples());
    if (samples_.empty()) {
        samples = std::max(samples, fewest);
    }
    return samples >= fewest ? static_cast<uint>(samples) : 0;
}

void PassSchedule::resume(std::vector<uint> samples, std::optional<double> error, const PassPace& pace,
                          uint begun_samples, double begun_part) {
    samples_ = std::move(samples);
    done_samples_ = std::accumulate(samples_.begin(), samples_.end(), 0.0);
    error_ = error;
    pace_ = pace;
    next_vpl_seconds_ = pace.vpl_seconds;
    is_resumed_ = true;
    begun_samples_ = begun_samples;
    present_part_ = 1.0 - begun_part;
}

std::optional<uint> PassSchedule::begin() {
    if (begun_samples_ > 0) {
        present_samples_ = std::exchange(begun_samples_, 0);
    } else {
        present_samples_ = next_samples();
        present_part_ = 1.0;
    }
    pass_watch_ = Stopwatch();
    mark_.reset();
    return present_samples_ > 0 ? std::optional(present_samples_) : std::nullopt;
}

bool PassSchedule::may_be_given_up() const {
    return seconds_ && !is_resumed_ && samples_.empty() && present_samples_ > min_samples_;
}

bool PassSchedule::is_too_long(double of_pass) {
    if (!may_be_given_up()) {
        return false;
    }
    if (!mark_) {
        const double in_gather = pass_watch_.seconds() - pace_.vpl_seconds;
        if (of_pass > 0.0 && (of_pass >= kIgnoredPart || in_gather >= kIgnoredPart * *seconds_)) {
            mark_ = Mark{.seconds = pass_watch_.seconds(), .fraction = of_pass};
        }
        return false;
    }
    const double passed = of_pass - mark_->fraction;
    const double elapsed = pass_watch_.seconds() - mark_->seconds;
    if (!(passed > 0.0) || (passed < kJudgedPart && elapsed < kJudgedPart * *seconds_)) {
        return false;
    }
    const double missing = elapsed / passed * (1.0 - of_pass);
    if (missing <= seconds_left() + kToleratedPart * *seconds_) {
        return false;
    }
    pace_.sample_seconds = elapsed / passed / present_samples_;
    return true;
}

void PassSchedule::end(std::optional<double> error) {
    samples_.push_back(present_samples_);
    done_samples_ += present_samples_;
    pace_.sample_seconds = (pass_watch_.seconds() - pace_.vpl_seconds) / (present_samples_ * present_part_);
    error_ = error;
}

uint PassSchedule::sure_next_samples() const {
    const std::size_t next = samples_.size() + 1;
    if (next >= max_passes_ || seconds_ || target_) {
        return 0;
    }
    return list_.empty() ? full_samples_ : list_[next];
}

double PassSchedule::rest_seconds(double of_pass) const {
    if (of_pass < kJudgedPart && pace_.sample_seconds) {
        return *pace_.sample_seconds * present_samples_ * present_part_ * (1.0 - of_pass);
    }
    const double in_gather = pass_watch_.seconds() - pace_.vpl_seconds;
    return of_pass > 0.0 ? in_gather / of_pass * (1.0 - of_pass) : 0.0;
}

double PassSchedule::fraction(double of_pass) const {
    const double of_present = 1.0 - present_part_ * (1.0 - of_pass);
    const double done = done_samples_ + of_present * present_samples_;
    const double all =
        list_.empty() ? 1.0 * full_samples_ * max_passes_ : std::accumulate(list_.begin(), list_.end(), 0.0);
    // A pass that is not given up is made to its end, also when the time is over.
    const double end = watch_.seconds() + (may_be_given_up() ? 0.0 : rest_seconds(of_pass));
    const double by_time = seconds_ ? watch_.seconds() / std::max(*seconds_, end) : 0.0;
    const double by_error = error_ && target_ ? done / std::max(needed_samples(), 1.0) : 0.0;
    return std::min(1.0, std::max({done / all, by_time, by_error}));
}

std::optional<PassForecast> PassSchedule::forecast() const {
    if (!error_ || !target_ || samples_.empty()) {
        return std::nullopt;
    }
    const auto done = static_cast<double>(samples_.size());
    const double unbelieved = *error_ > 0.0 ? believed_passes_ - done : 0.0;
    const double missing = std::max({0.0, (needed_samples() - done_samples_) / full_samples_, unbelieved});
    const double pass_seconds = next_vpl_seconds_ + full_samples_ * pace_.sample_seconds.value_or(0.0);
    const double seconds = watch_.seconds() + missing * pass_seconds;
    return PassForecast{
        .error = *error_,
        .passes = done + missing,
        .seconds = seconds,
        .reaches = std::ceil(done + missing) <= max_passes_ && !(seconds_ && seconds > *seconds_)};
}

}  // namespace nearlight::core
