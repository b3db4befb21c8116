// SPDX-License-Identifier: Apache-2.0
// From linear light to what a screen shows.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "host/base/math.h"

namespace nearlight::core {

enum class ToneCurve {
    linear,   ///< as it is; what is above 1 is clipped
    neutral,  ///< colours as they are up to 0.76, softly limited above [Khronos PBR Neutral Tone Mapper]
    agx,      ///< a photograph's contrast, where bright colours fade to white [Sobotka, AgX]
    filmic,   ///< strong contrast of film [Narkowicz, ACES Filmic Tone Mapping Curve, 2016]
};

std::string to_string(ToneCurve curve);
/// The curve of that name; empty if there is none.
std::optional<ToneCurve> tone_curve(const std::string& name);
/// All names, separated by commas.
std::string tone_curve_names();

/// The linear colour, not yet encoded, that a screen should show; in [0, 1] but for `linear`. What is
/// negative or NaN counts as 0.
Vec3 apply_tone_curve(ToneCurve curve, Vec3 color);

/// The exposure in stops at which a picture, of which `rgb` has three linear values a pixel, looks right on a
/// screen: what is seen is grey on the average, and hardly anything is white. Black pixels do not count, and
/// a picture of nothing else has the exposure 0.
float automatic_exposure(std::span<const float> rgb);

}  // namespace nearlight::core
