// SPDX-License-Identifier: Apache-2.0
// Unit vectors in 32 bits, as kernels/lib/math.cl packs them.
#pragma once

#include <algorithm>
#include <cmath>

#include "host/base/math.h"

namespace nearlight::core {

/// A unit vector as two numbers of 16 bits, by the octahedral map [Cigolle et al., A Survey of Efficient
/// Representations for Independent Unit Vectors, JCGT 2014].
inline uint pack_direction(Vec3 d) {
    const float sum = std::max(std::abs(d.x) + std::abs(d.y) + std::abs(d.z), 1e-20f);
    const float x = d.x / sum;
    const float y = d.y / sum;
    const bool is_folded = d.z < 0.0f;
    const float u = is_folded ? std::copysign(1.0f - std::abs(y), x) : x;
    const float v = is_folded ? std::copysign(1.0f - std::abs(x), y) : y;
    const auto scaled = [](float t) {
        return static_cast<uint>(std::round(std::clamp(t * 0.5f + 0.5f, 0.0f, 1.0f) * 65535.0f));
    };
    return scaled(u) | scaled(v) << 16u;
}

inline Vec3 unpack_direction(uint packed) {
    const float u = static_cast<float>(packed & 0xffffu) * (2.0f / 65535.0f) - 1.0f;
    const float v = static_cast<float>(packed >> 16u) * (2.0f / 65535.0f) - 1.0f;
    const float z = 1.0f - std::abs(u) - std::abs(v);
    const float x = z < 0.0f ? std::copysign(1.0f - std::abs(v), u) : u;
    const float y = z < 0.0f ? std::copysign(1.0f - std::abs(u), v) : v;
    return normalize(Vec3{x, y, z});
}

}  // namespace nearlight::core
