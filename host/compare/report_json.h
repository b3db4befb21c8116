// SPDX-License-Identifier: Apache-2.0
// compare.json, which scripts rely on: fields may be added, none changed. Numbers that do not exist are null:
// intervals of one seed, what `never` needs, policies of samplers without any.
#pragma once

#include <string>

#include "host/compare/comparison.h"

namespace nearlight::core {

/// The text of one JSON object.
std::string comparison_json(const Comparison& comparison, const CompareSettings& settings);

}  // namespace nearlight::core
