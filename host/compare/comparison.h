// SPDX-License-Identifier: Apache-2.0
// The comparison of samplers: scenes × methods × numbers of VPLs × seeds. Only indirect light is compared,
// with one reference per scene.
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
    std::vector<EqualRmse> equal_rmse{};  ///< EqualRmseRow::curve is an index into CompareSettings::methods
    SceneFigures figures{};
    std::vector<Plot> plots{};
};

struct Comparison {
    std::string device;
    std::string driver;
    std::size_t measured_cells = 0;  ///< cells that this run measured
    std::size_t reused_cells = 0;    ///< cells that were found in the output folder
    std::vector<SceneComparison> scenes{};
};

/// Receives the progress of a comparison, and can stop it.
struct CompareObserver {
    std::function<void(const std::string& step)> begin;
    /// Receives the fraction of the step that is done, 0 to 1, and the time that it will still take where a
    /// better estimate than the fraction's is known.
    std::function<void(double fraction, std::optional<double> seconds_left)> advance;
    std::function<bool()> stopped;  ///< called between cells, and several times a second within a reference
};

/// Measures the cells that are missing in settings.output and makes tables, figures and plots. Returns
/// nothing if it was stopped; the same call resumes. Settings must have passed check_settings(). Leaves
/// out, with a warning, scenes where there is nothing to compare: no light, nothing in view, paths that are too
/// short, or no indirect light that reaches the camera. Throws Error if this leaves none, or if a given
/// reference does not fit.
std::optional<Comparison> compare(Device& device, std::span<const Scene> scenes,
                                  const CompareSettings& settings, const CompareObserver& observer);

/// Names for files, one per scene: the scene's own name in letters, digits, '.', '_' and '-', with a number
/// if two scenes have the same name.
std::vector<std::string> unique_names(std::span<const Scene> scenes);

}  // namespace nearlight::core
