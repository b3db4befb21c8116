// SPDX-License-Identifier: Apache-2.0
// Convergence, drawn by gnuplot: RMSE over VPLs and over seconds, both axes logarithmic.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "host/compare/tables.h"

namespace nearlight::core {

struct Plot {
    std::string title;
    std::filesystem::path script;  ///< holds its own data; `gnuplot FILE` in its folder draws it again
    std::filesystem::path svg{};   ///< empty where gnuplot is missing or failed
    std::filesystem::path png{};
};

/// Writes the scripts to `folder` and runs them; warns once where gnuplot is not there.
std::vector<Plot> make_plots(const std::string& scene, const CompareSettings& settings,
                             std::span<const EqualVplsRow> rows, const std::filesystem::path& folder);

/// The script of one plot; `stem` names the files it writes. `over_seconds`: over generate + gather instead
/// of VPLs.
std::string plot_script(const std::string& title, const std::string& stem, bool over_seconds,
                        const CompareSettings& settings, std::span<const EqualVplsRow> rows);

}  // namespace nearlight::core
