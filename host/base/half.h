// SPDX-License-Identifier: Apache-2.0
// Half floats [IEEE 754 binary16], which textures are stored as.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

namespace nearlight::core {

inline constexpr float kMaxHalf = 65504.0f;

/// The exact value of a half float.
inline float half_to_float(std::uint16_t half) {
    const std::uint32_t sign = static_cast<std::uint32_t>(half & 0x8000u) << 16u;
    const std::uint32_t exponent = (half >> 10u) & 31u;
    const std::uint32_t mantissa = half & 1023u;
    if (exponent == 0) {
        const float magnitude = static_cast<float>(mantissa) * 0x1p-24f;
        return sign != 0 ? -magnitude : magnitude;
    }
    const std::uint32_t wide = exponent == 31 ? 255u : exponent + 112u;
    return std::bit_cast<float>(sign | (wide << 23u) | (mantissa << 13u));
}

/// The nearest half float of a finite value, ties to even. Values beyond ±65504 become ±65504.
inline std::uint16_t float_to_half(float value) {
    const std::uint16_t sign = std::signbit(value) ? 0x8000u : 0u;
    const float magnitude = std::fmin(std::fabs(value), kMaxHalf);
    if (magnitude < 0x1p-14f) {
        // Subnormal halves are multiples of 2⁻²⁴, and rounding to 2⁻¹⁴ gives the smallest normal one.
        return static_cast<std::uint16_t>(sign |
                                          static_cast<std::uint16_t>(std::nearbyint(magnitude * 0x1p24f)));
    }
    const std::uint32_t bits = std::bit_cast<std::uint32_t>(magnitude);
    const std::uint32_t rounded = bits + 0xfffu + ((bits >> 13u) & 1u);
    return static_cast<std::uint16_t>(sign | ((rounded - (112u << 23u)) >> 13u));
}

}  // namespace nearlight::core
