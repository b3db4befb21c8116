// SPDX-License-Identifier: Apache-2.0
// The test bench of many-light samplers: scenes × methods × counts of VPLs × seeds, all measured on the
// indirect light alone, against one truth.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "host/compare/figures.h"
#include "host/compare/plots.h"
#include "host/compare/tables.h"

namespace nearlight::core {

struct SceneComparison {
    SceneFacts facts;
    Reference reference;
    std::vector<EqualVplsRow> equal_vpls{};
    std::vector<EqualRmse> equal_rmse{};  ///< rows refer to CompareSettings::methods
    SceneFigures figures{};
    std::vector<Plot> plots{};
};

struct Comparison {
    std::string device;
    std::string driver;
    std::size_t measured_cells = 0;  ///< in this run
    std::size_t reused_cells = 0;    ///< found in the output folder
    std::vector<SceneComparison> scenes{};
};

/// What is told while it goes on.
struct CompareObserver {
    std::function<void(const std::string& step)> begin;
    /// How far the step is, 0 to 1, and how long it will still take, if that is known better than from the
    /// fraction.
    std::function<void(double fraction, std::optional<double> seconds_left)> advance;
    std::function<bool()> stopped;  ///< asked between cells, and several times a second within a reference
};

/// Measures what is missing in settings.output and makes tables, figures and plots. Nothing where it was
/// stopped; the same call goes on from there. Settings must have passed check_settings(). Throws Error where
/// a scene has nothing to compare, or a given reference does not fit.
std::optional<Comparison> compare(Device& device, std::span<const Scene> scenes,
                                  const CompareSettings& settings, const CompareObserver& observer);

/// Names for files, one a scene: its own name in letters, digits, '.', '_' and '-', numbered where two are
/// alike.
std::vector<std::string> unique_names(std::span<const Scene> scenes);

}  // namespace nearlight::core
