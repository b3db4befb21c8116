// SPDX-License-Identifier: Apache-2.0
// From linear light to what a screen shows.
#pragma once

namespace nearlight {

enum class ToneCurve {
    linear,   ///< as it is; what is above 1 is clipped
    neutral,  ///< colours as they are up to 0.76, softly limited above [Khronos PBR Neutral Tone Mapper]
    agx,      ///< a photograph's contrast, where bright colours fade to white [Sobotka, AgX]
    filmic,   ///< strong contrast of film [Narkowicz, ACES Filmic Tone Mapping Curve, 2016]
};

}  // namespace nearlight
