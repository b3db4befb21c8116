// SPDX-License-Identifier: Apache-2.0
// A clock for how long something takes.
#pragma once

#include <chrono>

namespace nearlight::core {

/// Measures wall-clock time since construction or the last lap.
class Stopwatch {
  public:
    [[nodiscard]] double seconds() const {
        return std::chrono::duration<double>(Clock::now() - start_).count();
    }
    /// Returns the seconds since the last lap, and starts the next lap.
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
