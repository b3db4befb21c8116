// SPDX-License-Identifier: Apache-2.0
// Data of the sky model of Hosek and Wilkie, in linear sRGB; each file names their licence.
#pragma once

namespace nearlight::core {

inline constexpr int kSkyTurbidities = 10;     ///< 1, 2, … 10
inline constexpr int kSkyAlbedos = 2;          ///< 0 and 1
inline constexpr int kSkyControlPoints = 6;    ///< of a Bézier curve over the sun's elevation
inline constexpr int kSkyModelParameters = 9;  ///< of the formula for one channel
inline constexpr int kSunElevations = 30;      ///< 2°, 5°, … 89°

extern const float
    kSkyParameters[kSkyTurbidities * kSkyAlbedos * kSkyControlPoints * 3 * kSkyModelParameters];
extern const float kSkyRadiance[kSkyTurbidities * kSkyAlbedos * kSkyControlPoints * 3];
/// W/m² across the direction of the sun, in Mitsuba's scale of colours.
extern const float kSunIrradiance[kSkyTurbidities * kSunElevations * 3];

}  // namespace nearlight::core
