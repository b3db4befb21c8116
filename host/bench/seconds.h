// SPDX-License-Identifier: Apache-2.0
// Times of benchmarks. Processor time is the one to trust on a machine with other load.
#pragma once

#include <ctime>

#include "host/base/stopwatch.h"

namespace nearlight::core {

struct Seconds {
    double wall = 0.0;
    double processor = 0.0;  ///< sum over all threads that worked; it does not contain a GPU's work
};

/// Wall time and processor time since construction, of the whole process or of the calling thread.
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
