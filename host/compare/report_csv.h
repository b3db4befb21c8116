// SPDX-License-Identifier: Apache-2.0
// The tables of all scenes as comma-separated values. The field of a number that does not exist is empty.
#pragma once

#include <string>

#include "host/compare/comparison.h"

namespace nearlight::core {

std::string equal_vpls_csv(const Comparison& comparison);
std::string equal_rmse_csv(const Comparison& comparison, const CompareSettings& settings);

}  // namespace nearlight::core
