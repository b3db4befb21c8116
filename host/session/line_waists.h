// SPDX-License-Identifier: Apache-2.0
// Where many half lines pass close to one another, as lines of sight do in a window.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "host/base/math.h"
#include "host/base/random.h"

namespace nearlight::core {

struct HalfLine {
    Vec3 origin{0, 0, 0};
    Vec3 direction{0, 0, 1};  ///< unit vector
};

/// The distance (m) between a point and the nearest point of the half line.
float distance_to(const HalfLine& line, Vec3 point);

/// A sphere through which a group of half lines pass.
struct Waist {
    Vec3 center{0, 0, 0};
    float radius = 0.0f;      ///< m; 85 % of the group's half lines pass through the sphere
    Vec3 direction{0, 0, 1};  ///< the mean of the group's, a unit vector
    float share = 0.0f;       ///< of all half lines that are in the group
};

/// Divides the half lines into up to `max_count` groups, each of which has at least a few, so that they pass
/// near the centres of their groups. The result depends on `random`, since only some of the ways to begin are
/// tried.
std::vector<Waist> find_waists(std::span<const HalfLine> lines, std::size_t max_count, Pcg32 random);

}  // namespace nearlight::core
