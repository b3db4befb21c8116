// SPDX-License-Identifier: Apache-2.0
// Vertices at the same place, which meshes may have more than once.
#pragma once

#include <array>
#include <span>
#include <unordered_map>
#include <vector>

#include "host/base/hash.h"
#include "host/base/math.h"

namespace nearlight::core {

/// Numbers places in the order in which they are asked for.
class Places {
  public:
    uint number(Vec3 p) {
        // Adding 0 makes −0 the same place as 0.
        return numbers_.try_emplace({p.x + 0.0f, p.y + 0.0f, p.z + 0.0f}, static_cast<uint>(numbers_.size()))
            .first->second;
    }

  private:
    struct Hash {
        std::size_t operator()(const std::array<float, 3>& place) const {
            return hash64(std::as_bytes(std::span(place)));
        }
    };
    std::unordered_map<std::array<float, 3>, uint, Hash> numbers_;
};

/// The number of each position's place.
inline std::vector<uint> places_of(std::span<const Vec3> positions) {
    Places places;
    std::vector<uint> numbers;
    numbers.reserve(positions.size());
    for (const Vec3 p : positions) {
        numbers.push_back(places.number(p));
    }
    return numbers;
}

}  // namespace nearlight::core
