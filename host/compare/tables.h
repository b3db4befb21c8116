// SPDX-License-Identifier: Apache-2.0
// Makes the rows of the tables from cells.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "host/compare/cell.h"
#include "host/compare/equal_rmse.h"
#include "host/compare/statistics.h"

namespace nearlight::core {

/// The figures of one method at one count, over all seeds.
struct EqualVplsRow {
    Method method;
    uint vpls = 0;             ///< number of VPLs that was asked for
    double gathered_vpls = 0;  ///< mean over seeds
    double sparse_vpls = 0;    ///< VPLs that only lit other VPLs, mean over seeds
    RmseEstimate rmse{};
    double rmse_ratio = 0;  ///< ÷ the baseline's at the same count
    Interval relative_mse{};
    Interval mean_ratio{};
    Interval flip{};
    double bias_floor = 0;  ///< lower bound (95 %) of the RMSE due to light lost or gained: √ of the mean
                            ///< over R, G and B of the squared mean error, each nearer to 0 by its interval
    double generate_seconds = 0;  ///< median over seeds
    double gather_seconds = 0;    ///< median over seeds
};

/// The rows, sorted by count, then in the order of the methods.
std::vector<EqualVplsRow> equal_vpls_rows(const CompareSettings& settings, std::span<const Cell> cells);

/// The curves for the table of equal RMSE, one per method, in their order. A method counts as biased if its
/// policy is `paper`, or if at its largest count it loses or gains more than 2 % of the light and this is
/// certain (95 %).
std::vector<Curve> curves_of(const CompareSettings& settings, std::span<const EqualVplsRow> rows);

/// A warning about a reference whose noise is unknown or more than a third of the smallest RMSE. Such a
/// reference is unreliable, because the noise that is subtracted is an estimate itself. Empty for a good
/// reference.
std::string noise_remark(const Reference& reference, std::span<const EqualVplsRow> rows);

/// Index of the baseline among the methods.
std::size_t baseline_index(const CompareSettings& settings);

}  // namespace nearlight::core
