// SPDX-License-Identifier: Apache-2.0
// What `nearlight bench gather` prints on a terminal.
#pragma once

#include <cstdint>
#include <string>

#include "host/bench/gather_bench.h"

namespace nearlight::core {

/// A count in millions, as both outputs of the command state it.
constexpr double millions(std::uint64_t count) {
    return static_cast<double>(count) * 1e-6;
}

/// The tracers, what they differ about (ten rays of each, and how many more), and the ratios last. `name` is
/// that of the segments.
std::string gather_bench_text(const std::string& name, BvhQuality bvh, const GatherBenchResult& result);

}  // namespace nearlight::core
