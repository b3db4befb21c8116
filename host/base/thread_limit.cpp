// SPDX-License-Identifier: Apache-2.0
#include "host/base/thread_limit.h"

#include <algorithm>

#ifndef NEARLIGHT_SERIAL
#include <tbb/global_control.h>
#endif

namespace nearlight::core {

#ifdef NEARLIGHT_SERIAL
struct ThreadLimit::Control {};

int allowed_threads() {
    return 1;
}
#else
struct ThreadLimit::Control {
    explicit Control(std::size_t threads) : control(tbb::global_control::max_allowed_parallelism, threads) {}
    tbb::global_control control;
};

int allowed_threads() {
    return static_cast<int>(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
}
#endif

std::size_t files_ahead(int most) {
    const int allowed = allowed_threads();
    return allowed == 1 ? 0 : static_cast<std::size_t>(std::min(allowed, most));
}

ThreadLimit::ThreadLimit(int threads) {
#ifndef NEARLIGHT_SERIAL
    if (threads > 0) {
        control_ = std::make_unique<Control>(static_cast<std::size_t>(threads));
    }
#else
    static_cast<void>(threads);
#endif
}
ThreadLimit::~ThreadLimit() = default;

}  // namespace nearlight::core
