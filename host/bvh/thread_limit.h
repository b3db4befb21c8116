// SPDX-License-Identifier: Apache-2.0
// How many threads the host's own work may take: building trees, path tracing.
#pragma once

#include <memory>

namespace nearlight::core {

/// At most `threads` while it lives, the caller's included; 0: one a core. What others ask for beside it
/// counts if it is less.
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

/// That may run now.
int allowed_threads();

}  // namespace nearlight::core
