// SPDX-License-Identifier: Apache-2.0
// Finds the tunables that make a device fastest, by trying values.
#pragma once

#include <string>
#include <vector>

#include "host/bench/statistics.h"
#include "host/cl/device.h"

namespace nearlight::core {

struct TunerConfig {
    std::size_t triangles = 25'000;  ///< of the generated room that is measured
    int size = 256;                  ///< width and height of the picture, pixels
    std::size_t vpl_count = 32;
    std::size_t sort_count = std::size_t{1} << 20u;
    int repeats = 7;
};

/// One value of a tunable that was tried.
struct TriedValue {
    std::uint32_t value = 0;
    Seconds median{};
    Ratio to_usual{};              ///< its time ÷ that of the table's value, repeat by repeat
    std::string failed_because{};  ///< empty if it ran
};

/// The trial of one tunable.
struct TunerTrial {
    std::string tunable;
    std::string measured_by;    ///< name of the work that was timed
    bool by_processor = false;  ///< the choice is by processor time, not by the wall clock
    std::uint32_t usual = 0;    ///< the table's value
    std::uint32_t chosen = 0;
    std::vector<TriedValue> tried;
};

struct TunerResult {
    std::string device;
    Tunables usual{};
    Tunables chosen{};
    std::vector<TunerTrial> trials;
    std::vector<std::string> kernels;  ///< files in kernels/ on which the choice depends
};

/// Tries one tunable after the other; all values of a tunable run in turn. The table's value stays unless
/// another one is faster by 3 % and by more than the repeats vary. The device keeps the chosen values. Throws
/// Error(ErrorKind::failure) if a result depends on a tunable.
TunerResult tune(Device& device, const TunerConfig& config = {});

}  // namespace nearlight::core
