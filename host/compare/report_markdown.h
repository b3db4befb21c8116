// SPDX-License-Identifier: Apache-2.0
// The comparison as Markdown, for documents and discussions: report.md, which refers to pictures/ beside it.
#pragma once

#include <string>

#include "host/compare/comparison.h"

namespace nearlight::core {

/// Tables of equal VPLs and equal RMSE a scene, positions of VPLs, and pictures with error maps at the
/// smallest count. Headings begin at the second level.
std::string comparison_markdown(const Comparison& comparison, const CompareSettings& settings);

}  // namespace nearlight::core
