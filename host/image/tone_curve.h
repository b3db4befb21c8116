// SPDX-License-Identifier: Apache-2.0
// From linear light to what a screen shows.
#pragma once

#include <array>
#include <string>
#include <utility>

#include "host/base/math.h"
#include "nearlight/tone_curve.h"

namespace nearlight::core {

/// The names of all tone curves.
inline constexpr std::array kToneCurves{
    std::pair{"neutral", ToneCurve::neutral}, std::pair{"agx", ToneCurve::agx},
    std::pair{"filmic", ToneCurve::filmic}, std::pair{"linear", ToneCurve::linear}};

std::string to_string(ToneCurve curve);

/// The linear colour, not yet encoded, that a screen should show. `linear` returns the colour as it is; the
/// others are in [0, 1], and take what is negative or NaN for 0.
Vec3 apply_tone_curve(ToneCurve curve, Vec3 color);

}  // namespace nearlight::core
