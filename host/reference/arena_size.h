// SPDX-License-Identifier: Apache-2.0
// How many threads a TBB arena of the reference has.
#pragma once

#include <tbb/task_arena.h>

#include <algorithm>

namespace nearlight::core {

/// Concurrency of a TBB arena for `threads` threads: at most the number of cores, which 0 stands for too.
inline int arena_size(int threads) {
    const int cores = tbb::this_task_arena::max_concurrency();
    return threads > 0 ? std::min(threads, cores) : cores;
}

}  // namespace nearlight::core
