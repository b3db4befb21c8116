// SPDX-License-Identifier: Apache-2.0
// What is rendered next: small pictures while the camera moves, then a whole one, then more passes for less
// noise. This knows no window, no clock and no session.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>

namespace nearlight::viewer {

enum class StepKind {
    reduced,   ///< a small picture while something changes
    full,      ///< the first picture of full size
    refining,  ///< one more pass, which is averaged with those before
};

struct Step {
    StepKind kind = StepKind::full;
    int divisor = 1;          ///< of width and height
    std::uint32_t pass = 0;   ///< passes of full size since the last change
    std::uint64_t state = 0;  ///< number of the state of camera and settings that it shows
};

/// The state machine of progressive refinement. Not for several threads.
class Refinement {
  public:
    /// Makes at most `max_passes` passes of a picture, 1 or more.
    explicit Refinement(std::uint32_t max_passes) : max_passes_(max_passes) {}

    /// Camera or settings have changed: the picture begins anew.
    void restart() { ++state_; }
    /// A new limit, above or below what is done. The picture does not begin anew.
    void set_max_passes(std::uint32_t max_passes) { max_passes_ = max_passes; }

    /// What to do now; nothing if the picture has all its passes.
    [[nodiscard]] std::optional<Step> next() const;
    /// Whether a step that is under way is worth no more work. Small pictures are finished in any case, so
    /// that something is seen during a long motion.
    [[nodiscard]] bool is_outdated(const Step& step) const;
    /// A step that next() gave has ended, after so many seconds. `completed` is false if it was stopped.
    void finish(const Step& step, bool completed, double seconds);
    /// A step that next() gave cannot be made: there is nothing more to do until something changes.
    void give_up(const Step& step) { failed_state_ = std::max(failed_state_, step.state); }

  private:
    void adapt_divisor(double seconds);

    std::uint32_t max_passes_;
    std::uint64_t state_ = 1;
    std::uint64_t reduced_state_ = 0;  ///< the latest state that a small picture shows
    std::uint64_t full_state_ = 0;     ///< the state that `passes_` counts for
    std::uint64_t failed_state_ = 0;   ///< the latest state that cannot be shown
    std::uint32_t passes_ = 0;
    int divisor_ = 2;  ///< of the next small picture: chosen so that about six are made in a second
};

}  // namespace nearlight::viewer
