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
#endif

namespace nearlight::core {

/// Calls body(first, last) for parts of [0, count) of about `grain` elements.
template <typename Body>
void parallel_for(std::size_t count, std::size_t grain, const Body& body) {
#ifdef NEARLIGHT_SERIAL
    static_cast<void>(grain);
    body(std::size_t{0}, count);
#else
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, grain),
                      [&](const auto& part) { body(part.begin(), part.end()); });
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
    return tbb::parallel_reduce(
        tbb::blocked_range<std::size_t>(0, count, grain), empty,
        [&](const auto& part, Sum sum) {
            add(sum, part.begin(), part.end());
            return sum;
        },
        [](Sum left, const Sum& right) {
            left.add(right);
            return left;
        });
#endif
}

template <typename First, typename Second>
void parallel_invoke(const First& first, const Second& second) {
#ifdef NEARLIGHT_SERIAL
    first();
    second();
#else
    tbb::parallel_invoke(first, second);
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
