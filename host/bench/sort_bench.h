// SPDX-License-Identifier: Apache-2.0
// Measures the radix sort and the prefix sum beside the host's libraries and beside plain copying.
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

/// One way to do a piece of work.
struct SortFigures {
    std::string name;
    Seconds median{};
    double bytes = 0.0;  ///< that it reads and writes at least
    bool is_right = true;
};

/// Others' seconds over ours, run by run: wall clock, and processor time where the device is a CPU (otherwise
/// 0).
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

/// Sorts pairs of a random 32-bit key and its index (the others as one 64-bit number each, which gives the
/// same order), and sums 32-bit numbers. Every repeat runs everything in turn; data is laid out beforehand,
/// untimed.
SortBenchResult bench_sort(Device& device, const SortBenchConfig& config = {});

}  // namespace nearlight::core
