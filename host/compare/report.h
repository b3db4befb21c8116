// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "host/compare/comparison.h"

namespace nearlight::core {

/// Writes compare.json, equal_vpls.csv, equal_rmse.csv, report.html and report.md into settings.output and
/// returns the text of compare.json. Throws Error(ErrorKind::file) if a file cannot be written.
std::string write_report(const Comparison& comparison, const CompareSettings& settings);

}  // namespace nearlight::core
