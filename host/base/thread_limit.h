// SPDX-License-Identifier: Apache-2.0
// A limit on the threads of the host's own work, such as reading files, building trees and path tracing.
#pragma once

#include <memory>

namespace nearlight::core {

/// Limits work to `threads` threads, the caller's included, while it lives; 0 means one a core. Of several
/// limits the lowest counts.
class ThreadLimit {
  public:
    explicit ThreadLimit(int threads);
    ThreadLimit(const ThreadLimit&) = delete;
    ThreadLimit& operator=(const ThreadLimit&) = delete;
    ~ThreadLimit();

  private:
    struct Control;
    std::unique_ptr<Control> control_;
};

/// The number of threads that may run now.
int allowed_threads();
/// How many files other threads may read ahead of the caller, at most `most`. With one thread allowed it is
/// none: then the caller reads each file itself when its turn comes.
std::size_t files_ahead(int most);

}  // namespace nearlight::core
