// SPDX-License-Identifier: Apache-2.0
// How long the cells that are left will take.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>

#include "host/compare/cell.h"

namespace nearlight::core {

/// The time of a cell is taken to be in proportion to VPLs × receivers; all cells of a comparison have the
/// same receivers. Each method has its own rate, learnt from what was measured of it, or else from all.
class CostModel {
  public:
    void add(const CellId& cell, double seconds);
    /// Nothing as long as nothing was measured.
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
