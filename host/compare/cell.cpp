// SPDX-License-Identifier: Apache-2.0
#include "host/compare/cell.h"

namespace nearlight::core {

std::vector<CellId> cells_of(const CompareSettings& settings) {
    std::vector<CellId> cells;
    for (uint i = 0; i < settings.seed_count; ++i) {
        for (const uint vpls : settings.vpl_counts) {
            for (const Method& method : settings.methods) {
                cells.push_back({method, vpls, settings.first_seed + i});
            }
        }
    }
    return cells;
}

}  // namespace nearlight::core
