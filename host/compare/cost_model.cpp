// SPDX-License-Identifier: Apache-2.0
#include "host/compare/cost_model.h"

namespace nearlight::core {

void CostModel::add(const CellId& cell, double seconds) {
    for (Sum* const sum : {&methods_[to_string(cell.method)], &all_}) {
        sum->seconds += seconds;
        sum->vpls += static_cast<double>(cell.vpls);
    }
}

std::optional<double> CostModel::seconds(std::span<const CellId> cells) const {
    if (all_.vpls <= 0.0) {
        return std::nullopt;
    }
    double total = 0.0;
    for (const CellId& cell : cells) {
        const auto known = methods_.find(to_string(cell.method));
        const Sum& sum = known == methods_.end() ? all_ : known->second;
        total += static_cast<double>(cell.vpls) * sum.seconds / sum.vpls;
    }
    return total;
}

}  // namespace nearlight::core
