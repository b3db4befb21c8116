// SPDX-License-Identifier: Apache-2.0
// The report: one page that holds all its pictures and needs no network.
#pragma once

#include <string>

#include "host/compare/comparison.h"

namespace nearlight::core {

/// Reads the figures and plots that the comparison names. Throws Error(ErrorKind::file) where one is gone.
std::string comparison_html(const Comparison& comparison, const CompareSettings& settings);

}  // namespace nearlight::core
