// SPDX-License-Identifier: Apache-2.0
// Finds the tunables that make a device fastest, by trying.
#pragma once

#include <string>
#include <vector>

#include "host/bench/statistics.h"
#include "host/cl/device.h"

namespace nearlight::core {

struct TunerConfig {
    std::size_t triangles = 25'000;  ///< of the made-up room that is measured
    int size = 256;                  ///< of the picture's sides, pixels
    std::size_t vpl_count = 32;
    std::size_t sort_count = std::size_t{1} << 20u;
    int repeats = 7;
};

struct TunerCandidate {
    std::uint32_t value = 0;
    Seconds median{};
    Ratio to_usual{};              ///< its time ÷ that of the table's value, run by run
    std::string failed_because{};  ///< empty where it ran
};

/// One tunable.
struct TunerTrial {
    std::string tunable;
    std::string measured_by;    ///< on which work
    bool by_processor = false;  ///< decided by processor time, not by the wall clock
    std::uint32_t usual = 0;    ///< the table's value
    std::uint32_t chosen = 0;
    std::vector<TunerCandidate> candidates;
};

struct TunerResult {
    std::string device;
    Tunables usual{};
    Tunables chosen{};
    std::vector<TunerTrial> trials;
    std::vector<std::string> kernels;  ///< files under kernels/ on which the choice depends
};

/// Tries one tunable after the other, all candidates of one by turns. The table's value stays unless another
/// is faster by more than the runs vary, and by 3 %. Leaves the device with what was chosen. Throws
/// Error(ErrorKind::failure) if a result depends on a tunable.
TunerResult tune(Device& device, const TunerConfig& config = {});

}  // namespace nearlight::core
