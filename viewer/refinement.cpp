// SPDX-License-Identifier: Apache-2.0
#include "viewer/refinement.h"

namespace nearlight::viewer {
namespace {

constexpr int kMinDivisor = 2;
constexpr int kMaxDivisor = 8;
/// A small picture that takes longer is made smaller the next time.
constexpr double kMaxReducedSeconds = 0.17;
/// A picture twice as wide takes at most four times as long, so one that takes less than this can be larger.
constexpr double kMinReducedSeconds = 0.035;

}  // namespace

std::optional<Step> Refinement::next() const {
    if (failed_state_ == state_) {
        return std::nullopt;
    }
    if (full_state_ == state_) {
        if (passes_ >= max_passes_) {
            return std::nullopt;
        }
        return Step{.kind = StepKind::refining, .pass = passes_, .state = state_};
    }
    if (reduced_state_ != state_) {
        return Step{.kind = StepKind::reduced, .divisor = divisor_, .state = state_};
    }
    return Step{.kind = StepKind::full, .state = state_};
}

bool Refinement::is_outdated(const Step& step) const {
    return step.kind != StepKind::reduced && step.state != state_;
}

void Refinement::finish(const Step& step, bool completed, double seconds) {
    if (!completed) {
        return;
    }
    if (step.kind == StepKind::reduced) {
        reduced_state_ = step.state;
        adapt_divisor(seconds);
    } else if (step.state == state_) {
        passes_ = step.pass + 1;
        full_state_ = state_;
    }
}

void Refinement::adapt_divisor(double seconds) {
    if (seconds > kMaxReducedSeconds && divisor_ < kMaxDivisor) {
        divisor_ *= 2;
    } else if (seconds < kMinReducedSeconds && divisor_ > kMinDivisor) {
        divisor_ /= 2;
    }
}

}  // namespace nearlight::viewer
