// SPDX-License-Identifier: Apache-2.0
// Tables of pairs of a name and a value.
#pragma once

#include <algorithm>

namespace nearlight::core {

/// The name of a value in a table, which must have it.
template <typename Table, typename Value>
constexpr const char* name_in(const Table& table, Value value) {
    return std::ranges::find(table, value, [](const auto& entry) { return entry.second; })->first;
}

}  // namespace nearlight::core
