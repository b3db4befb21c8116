// SPDX-License-Identifier: Apache-2.0
// Plots and pictures of a scene as HTML.
#pragma once

#include "host/compare/comparison.h"
#include "host/compare/html_writer.h"

namespace nearlight::core {

void write_plots(HtmlWriter& html, const SceneComparison& scene);
/// Writes the figures that show the positions of VPLs.
void write_vpl_figures(HtmlWriter& html, const SceneComparison& scene);
/// Writes the pictures of all methods with their error maps, one row per count.
void write_method_figures(HtmlWriter& html, const SceneComparison& scene, const CompareSettings& settings);

}  // namespace nearlight::core
