// SPDX-License-Identifier: Apache-2.0
// Writes report.md, the comparison as Markdown for documents and discussions. It refers to the pictures in
// pictures/ beside it.
#pragma once

#include <string>

#include "host/compare/comparison.h"

namespace nearlight::core {

/// The text of report.md. Each scene has tables of equal VPLs and equal RMSE, the positions of VPLs, and
/// pictures with error maps at the smallest count. Headings begin at the second level.
std::string comparison_markdown(const Comparison& comparison, const CompareSettings& settings);

}  // namespace nearlight::core
