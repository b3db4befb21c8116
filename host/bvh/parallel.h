// SPDX-License-Identifier: Apache-2.0
// Functions by which the builder shares work between threads. Without oneTBB (NEARLIGHT_SERIAL) one thread
// does everything, with the same results.
#pragma once

#include <cstddef>

#ifndef NEARLIGHT_SERIAL
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>
#include <tbb/parallel_reduce.h>

#include "host/base/fork_join.h"
#endif

namespace nearlight::core {

/// Calls body(first, last) for parts of [0, count) of about `grain` elements.
template <typename Body>
void parallel_for(std::size_t count, std::size_t grain, const Body& body) {
#ifdef NEARLIGHT_SERIAL
    static_cast<void>(grain);
    body(std::size_t{0}, count);
#else
    const auto work = [&](const auto& part) { body(part.begin(), part.end()); };
    ForkJoin fork;
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, grain), fork.task(work));
#endif
}

/// Calls add(sum, first, last) for parts of [0, count), whose sums begin as copies of `empty` and are
/// combined by sum.add(other).
template <typename Sum, typename Add>
Sum parallel_sum(std::size_t count, std::size_t grain, const Sum& empty, const Add& add) {
#ifdef NEARLIGHT_SERIAL
    static_cast<void>(grain);
    Sum sum = empty;
    add(sum, std::size_t{0}, count);
    return sum;
#else
    const auto sum_of_part = [&](const auto& part, Sum sum) {
        add(sum, part.begin(), part.end());
        return sum;
    };
    const auto sum_of_both = [](Sum left, const Sum& right) {
        left.add(right);
        return left;
    };
    ForkJoin fork;
    return tbb::parallel_reduce(tbb::blocked_range<std::size_t>(0, count, grain), empty,
                                fork.task(sum_of_part), fork.combination(sum_of_both));
#endif
}

template <typename First, typename Second>
void parallel_invoke(const First& first, const Second& second) {
#ifdef NEARLIGHT_SERIAL
    first();
    second();
#else
    ForkJoin fork;
    tbb::parallel_invoke(fork.task(first), fork.task(second));
#endif
}

/// The number of upper levels of a recursion over a tree on which invoke_at_level() works in parallel.
constexpr int kParallelLevels = 8;
/// Calls both functions: in parallel on the upper kParallelLevels levels of a recursion, otherwise in turn.
template <typename First, typename Second>
void invoke_at_level(int level, const First& first, const Second& second) {
    if (level < kParallelLevels) {
        parallel_invoke(first, second);
    } else {
        first();
        second();
    }
}

}  // namespace nearlight::core
