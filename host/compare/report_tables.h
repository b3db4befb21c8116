// SPDX-License-Identifier: Apache-2.0
// Writes the tables as HTML: the summary, and the two tables of each scene.
#pragma once

#include "host/compare/comparison.h"
#include "host/compare/html_writer.h"

namespace nearlight::core {

/// Writes one row for each scene and method, with geometric means over all counts.
void write_summary_table(HtmlWriter& html, const Comparison& comparison, const CompareSettings& settings);
void write_equal_vpls_table(HtmlWriter& html, const SceneComparison& scene, const CompareSettings& settings);
void write_equal_rmse_table(HtmlWriter& html, const SceneComparison& scene, const CompareSettings& settings);

}  // namespace nearlight::core
