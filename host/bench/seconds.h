// SPDX-License-Identifier: Apache-2.0
// Time as benchmarks take it. Processor time tells on a machine that others use too.
#pragma once

#include <ctime>

#include "host/base/stopwatch.h"

namespace nearlight::core {

struct Seconds {
    double wall = 0.0;
    double processor = 0.0;  ///< of all threads that worked, summed; a GPU's work is not in it
};

/// Both times of a stretch, of the whole process or of the calling thread.
class TwoClocks {
  public:
    enum class Of { process, thread };
    explicit TwoClocks(Of of)
        : clock_(of == Of::process ? CLOCK_PROCESS_CPUTIME_ID : CLOCK_THREAD_CPUTIME_ID) {}

    [[nodiscard]] Seconds seconds() const { return {wall_.seconds(), processor_seconds() - start_}; }

  private:
    [[nodiscard]] double processor_seconds() const {
        timespec now{};
        clock_gettime(clock_, &now);
        return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
    }

    clockid_t clock_;
    Stopwatch wall_;
    double start_ = processor_seconds();
};

}  // namespace nearlight::core
