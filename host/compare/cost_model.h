// SPDX-License-Identifier: Apache-2.0
// Estimates how long the remaining cells will take.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>

#include "host/compare/cell.h"

namespace nearlight::core {

/// Assumes that the time of a cell is proportional to VPLs × receivers; all cells of a comparison have the
/// same receivers. The rate of a method comes from its own measured cells, or from all methods' where it has
/// none.
class CostModel {
  public:
    void add(const CellId& cell, double seconds);
    /// Estimated seconds for the cells; empty before anything was measured.
    [[nodiscard]] std::optional<double> seconds(std::span<const CellId> cells) const;

  private:
    struct Sum {
        double seconds = 0;
        double vpls = 0;
    };
    std::map<std::string, Sum> methods_;
    Sum all_;
};

}  // namespace nearlight::core
