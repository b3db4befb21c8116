// SPDX-License-Identifier: Apache-2.0
// Measures the radix sort and the prefix sum, the host's libraries and plain copying side by side.
#pragma once

#include <string>
#include <vector>

#include "host/bench/seconds.h"
#include "host/cl/device.h"

namespace nearlight::core {

struct SortBenchConfig {
    std::size_t count = 10'000'000;  ///< keys
    int repeats = 11;
};

/// The figures of one way to sort, to sum or to copy.
struct SortFigures {
    std::string name;
    Seconds median{};
    double bytes = 0.0;  ///< minimum number of bytes that it reads and writes
    bool is_right = true;
};

/// The median over the repeats of another way's seconds divided by ours: by the wall clock, and by processor
/// time where the device is a CPU (otherwise 0).
struct SortRatio {
    std::string name;
    double wall = 0.0;
    double processor = 0.0;
};

struct SortBenchResult {
    std::string device;
    std::size_t count = 0;
    std::vector<SortFigures> figures;
    std::vector<SortRatio> ratios;
};

/// Sorts pairs of a random 32-bit key and its index, and sums 32-bit numbers. The host's libraries sort each
/// pair as one 64-bit number, which gives the same order. Every repeat runs everything in turn; the data is
/// laid out beforehand and that is not timed.
SortBenchResult bench_sort(Device& device, const SortBenchConfig& config = {});

}  // namespace nearlight::core
