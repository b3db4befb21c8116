// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>

namespace nearlight::core {

/// Wall-clock time since construction or the last lap.
class Stopwatch {
  public:
    [[nodiscard]] double seconds() const {
        return std::chrono::duration<double>(Clock::now() - start_).count();
    }
    /// Time since the last lap; starts the next one.
    double lap() {
        const double elapsed = seconds();
        start_ = Clock::now();
        return elapsed;
    }

  private:
    using Clock = std::chrono::steady_clock;
    Clock::time_point start_ = Clock::now();
};

}  // namespace nearlight::core
