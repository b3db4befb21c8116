// SPDX-License-Identifier: Apache-2.0
// The report: one page that holds all its pictures and needs no network.
#pragma once

#include <string>

#include "host/compare/comparison.h"

namespace nearlight::core {

/// The text of the page. Reads the figures and plots that the comparison names, and throws
/// Error(ErrorKind::file) if one is missing.
std::string comparison_html(const Comparison& comparison, const CompareSettings& settings);

}  // namespace nearlight::core
