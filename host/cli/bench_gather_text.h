// SPDX-License-Identifier: Apache-2.0
// The text that `nearlight bench gather` prints on a terminal.
#pragma once

#include <cstdint>
#include <string>

#include "host/bench/gather_bench.h"

namespace nearlight::core {

/// A count in millions, the unit of the command's text and JSON.
constexpr double millions(std::uint64_t count) {
    return static_cast<double>(count) * 1e-6;
}

/// A table of the tracers, their disagreements (ten rays of each, and the number of others), and the ratios.
/// `name` is the name of the segments.
std::string gather_bench_text(const std::string& name, BvhQuality bvh, const GatherBenchResult& result);

}  // namespace nearlight::core
