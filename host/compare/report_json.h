// SPDX-License-Identifier: Apache-2.0
// Writes compare.json. Scripts rely on its fields, so fields may be added but not changed. Values that do not
// exist are null: intervals of one seed, the needs of a method with the reach `never`, and policies of
// samplers that have none.
#pragma once

#include <string>

#include "host/compare/comparison.h"

namespace nearlight::core {

/// The text of one JSON object.
std::string comparison_json(const Comparison& comparison, const CompareSettings& settings);

}  // namespace nearlight::core
