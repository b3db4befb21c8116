// SPDX-License-Identifier: Apache-2.0
// The largest numbers that settings may have. The library, the commands and files check the same ones.
#pragma once

#include "kernels/shared/types.h"

namespace nearlight::core {

inline constexpr int kMaxPictureSide = 65536;        ///< of width and height, pixels
inline constexpr uint kMaxVpls = 50'000'000;         ///< VPLs of a set
inline constexpr uint kMaxSamplesPerPixel = 65536;   ///< of a pass
inline constexpr uint kMaxLightSamples = 1'000'000;  ///< light samples, and rays, of a pixel
inline constexpr uint kMaxPathDepth = 1024;          ///< as Mitsuba counts it
inline constexpr float kMaxLength = 1e9f;            ///< of a range or clamp radius, m
inline constexpr uint kMaxPasses = 1'000'000;
inline constexpr int kMaxFrame = 999'999;

}  // namespace nearlight::core
