// SPDX-License-Identifier: Apache-2.0
// The sRGB curve of screens and of PNG files [IEC 61966-2-1].
#pragma once

#include <cmath>

namespace nearlight::viewer {

/// Both functions take values from 0 to 1 to values from 0 to 1.
inline float srgb_of_linear(float linear) {
    return linear <= 0.0031308f ? linear * 12.92f : 1.055f * std::pow(linear, 1.0f / 2.4f) - 0.055f;
}
inline float linear_of_srgb(float code) {
    return code <= 0.04045f ? code / 12.92f : std::pow((code + 0.055f) / 1.055f, 2.4f);
}

}  // namespace nearlight::viewer
