// SPDX-License-Identifier: Apache-2.0
#include "host/stages/importon_groups.h"

#include <algorithm>
#include <array>
#include <functional>
#include <limits>
#include <span>

#include "host/base/math.h"

namespace nearlight::core {
namespace {

/// The distance between opposite normals, as a part of the extent of all positions.
constexpr float kNormalDistance = 0.5f;

using Key = std::array<float, 6>;

Key key_of(const Importon& importon, float normal_scale) {
    const Vec3 n = normal_scale * importon.normal;
    return {importon.position.x, importon.position.y, importon.position.z, n.x, n.y, n.z};
}

Key extent_of(std::span<const Importon> importons, float normal_scale) {
    Key low;
    Key high;
    low.fill(std::numeric_limits<float>::infinity());
    high.fill(-std::numeric_limits<float>::infinity());
    for (const Importon& importon : importons) {
        const Key key = key_of(importon, normal_scale);
        for (std::size_t axis = 0; axis < key.size(); ++axis) {
            low[axis] = std::min(low[axis], key[axis]);
            high[axis] = std::max(high[axis], key[axis]);
        }
    }
    Key extent;
    std::ranges::transform(high, low, extent.begin(), std::minus());
    return extent;
}

void split(std::span<Importon> importons, std::size_t wanted, float normal_scale,
           std::vector<std::vector<Importon>>& groups) {
    if (wanted == 1) {
        groups.emplace_back(importons.begin(), importons.end());
        return;
    }
    const Key extent = extent_of(importons, normal_scale);
    const auto axis = static_cast<std::size_t>(std::ranges::max_element(extent) - extent.begin());
    const std::size_t wanted_below = wanted / 2;
    const std::size_t below = importons.size() * wanted_below / wanted;
    std::ranges::nth_element(importons, importons.begin() + static_cast<std::ptrdiff_t>(below), {},
                             [&](const Importon& importon) { return key_of(importon, normal_scale)[axis]; });
    split(importons.first(below), wanted_below, normal_scale, groups);
    split(importons.subspan(below), wanted - wanted_below, normal_scale, groups);
}

}  // namespace

std::vector<std::vector<Importon>> group_importons(std::vector<Importon> importons, std::size_t wanted) {
    std::vector<std::vector<Importon>> groups;
    const Key extent = extent_of(importons, 0.0f);
    const float diagonal = length({extent[0], extent[1], extent[2]});
    if (!importons.empty() && wanted > 0) {
        split(importons, std::min(wanted, importons.size()), 0.5f * kNormalDistance * diagonal, groups);
    }
    return groups;
}

}  // namespace nearlight::core
