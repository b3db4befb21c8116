// SPDX-License-Identifier: Apache-2.0
// The sRGB transfer curve [IEC 61966-2-1] for values in [0, 1].
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace nearlight::core {

inline float srgb_to_linear(float encoded) {
    return encoded <= 0.04045f ? encoded / 12.92f : std::pow((encoded + 0.055f) / 1.055f, 2.4f);
}

inline float linear_to_srgb(float linear) {
    return linear <= 0.0031308f ? linear * 12.92f : 1.055f * std::pow(linear, 1.0f / 2.4f) - 0.055f;
}

/// The sRGB code of a linear value, clamped to [0, 1] and rounded to the nearest of 256 steps; NaN becomes 0.
inline std::uint8_t linear_to_srgb8(float linear) {
    const float clamped = linear > 0.0f ? std::min(linear, 1.0f) : 0.0f;
    return static_cast<std::uint8_t>(linear_to_srgb(clamped) * 255.0f + 0.5f);
}

}  // namespace nearlight::core
