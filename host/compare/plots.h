// SPDX-License-Identifier: Apache-2.0
// Plots of convergence, drawn by gnuplot: RMSE over VPLs and over seconds, on logarithmic axes.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "host/compare/tables.h"

namespace nearlight::core {

struct Plot {
    std::string title;
    std::filesystem::path script;   ///< contains its data; `gnuplot FILE` in its folder draws the plot again
    std::filesystem::path svg{};    ///< empty if the plot is missing
    std::filesystem::path png{};    ///< empty if the plot is missing
    std::string missing_because{};  ///< reason, as the end of a sentence; empty if the plot is there
};

/// Writes the scripts to `folder` and runs them. Warns once if plots are missing.
std::vector<Plot> make_plots(const std::string& scene, const CompareSettings& settings,
                             std::span<const EqualVplsRow> rows, const std::filesystem::path& folder);

/// The gnuplot script of one plot, which writes files with the name `stem`. The horizontal axis is the number
/// of VPLs, or with `over_seconds` the seconds of generate + gather.
std::string plot_script(const std::string& title, const std::string& stem, bool over_seconds,
                        const CompareSettings& settings, std::span<const EqualVplsRow> rows);

}  // namespace nearlight::core
