// SPDX-License-Identifier: Apache-2.0
// From cells to the rows of the tables.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "host/compare/cell.h"
#include "host/compare/equal_rmse.h"
#include "host/compare/statistics.h"

namespace nearlight::core {

/// One method at one count, over all seeds.
struct EqualVplsRow {
    Method method;
    uint vpls = 0;             ///< asked for
    double gathered_vpls = 0;  ///< mean over seeds, as the next
    double sparse_vpls = 0;    ///< that only lit other VPLs
    RmseEstimate rmse{};
    double rmse_ratio = 0;  ///< ÷ the baseline's at the same count
    Interval relative_mse{};
    Interval mean_ratio{};
    Interval flip{};
    double bias_floor =
        0;  ///< the RMSE that light lost or gained alone makes, at least (95 %): √ of the mean over R,
            ///< G and B of the squared mean error, each nearer to 0 by its interval
    double generate_seconds = 0;  ///< median over seeds, as the next
    double gather_seconds = 0;
};

/// Rows by count, then in the order of the methods.
std::vector<EqualVplsRow> equal_vpls_rows(const CompareSettings& settings, std::span<const Cell> cells);

/// What the table of equal RMSE is made from, one curve a method, in their order. A method is biased if its
/// policy is `paper`, or if at its largest count light is lost or gained for certain (95 %) and by more than
/// 2 %.
std::vector<Curve> curves_of(const CompareSettings& settings, std::span<const EqualVplsRow> rows);

/// What is to be said of a reference whose noise is not known, or more than a third of the smallest RMSE: it
/// is a poor judge then, for what is subtracted is an estimate itself. Empty where it is good.
std::string noise_remark(const Reference& reference, std::span<const EqualVplsRow> rows);

/// Index of the baseline among the methods.
std::size_t baseline_index(const CompareSettings& settings);

}  // namespace nearlight::core
