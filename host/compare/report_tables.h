// SPDX-License-Identifier: Apache-2.0
// Both tables of a scene as HTML.
#pragma once

#include "host/compare/comparison.h"
#include "host/compare/html_writer.h"

namespace nearlight {

void write_equal_vpls_table(HtmlWriter& html, const SceneComparison& scene, const CompareSettings& settings);
void write_equal_rmse_table(HtmlWriter& html, const SceneComparison& scene, const CompareSettings& settings);

}  // namespace nearlight
