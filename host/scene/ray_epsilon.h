// SPDX-License-Identifier: Apache-2.0
// How far a ray that leaves a surface starts from it. Kernels use the same formula.
#pragma once

#include <cmath>

#include "host/base/math.h"

namespace nearlight::core {

/// Distance (m) by which a point p on a surface is moved off it: some rounding errors of its coordinates, and
/// at least those of a point 5 % of `extent` (largest side of the scene's bounds, m) from the origin.
inline float ray_epsilon(Vec3 p, float extent) {
    const Vec3 magnitude{std::abs(p.x), std::abs(p.y), std::abs(p.z)};
    return 2e-5f * std::max(max_component(magnitude), 0.05f * extent);
}

/// The point p moved off its surface along the unit geometric normal, which points to the side on which the
/// ray continues.
inline Vec3 stand_off(Vec3 p, Vec3 normal, float extent) {
    return p + normal * ray_epsilon(p, extent);
}

}  // namespace nearlight::core
