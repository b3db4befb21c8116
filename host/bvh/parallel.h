// SPDX-License-Identifier: Apache-2.0
// The ways in which the builder shares work between threads; without oneTBB (NEARLIGHT_SERIAL) one
// thread does it all. Results are the same.
#pragma once

#include <cstddef>

#ifndef NEARLIGHT_SERIAL
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>
#include <tbb/parallel_reduce.h>
#endif

namespace nearlight::core {

/// body(first, last) for parts of [0, count) of about `grain`.
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

/// add(sum, first, last) for parts of [0, count), each from a copy of `empty`, put together by
/// sum.add(other).
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

/// Both in parallel on the upper levels of a recursion over a tree, one after the other below.
constexpr int kParallelLevels = 8;
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
