// SPDX-License-Identifier: Apache-2.0
// Random directions on the host.
#pragma once

#include "host/base/math.h"
#include "host/base/random.h"

namespace nearlight::core {

/// A unit vector about the unit normal, with density cosθ/π.
inline Vec3 cosine_direction(Vec3 normal, Pcg32& random) {
    const float r2 = random.uniform();
    const float phi = 2.0f * kPi * random.uniform();
    const auto [tangent, bitangent] = orthonormal_basis(normal);
    return tangent * (std::sqrt(r2) * std::cos(phi)) + bitangent * (std::sqrt(r2) * std::sin(phi)) +
           normal * std::sqrt(1.0f - r2);
}

}  // namespace nearlight::core
