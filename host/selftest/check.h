// SPDX-License-Identifier: Apache-2.0
// The result of comparing one kernel with its oracle.
#pragma once

#include <cstddef>
#include <string>

namespace nearlight::core {

struct CheckResult {
    std::string name;
    std::size_t cases = 0;       ///< things compared
    std::size_t mismatches = 0;  ///< number of cases that differ by more than rounding explains
    std::string problem;         ///< why the check could not run; empty if it ran

    [[nodiscard]] bool pass() const { return cases > 0 && mismatches == 0 && problem.empty(); }
    /// Counts one comparison.
    void expect(bool right) {
        ++cases;
        mismatches += right ? 0 : 1;
    }
};

}  // namespace nearlight::core
