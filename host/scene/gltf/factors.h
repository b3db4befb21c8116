// SPDX-License-Identifier: Apache-2.0
// Factors of glTF materials, limited to what the format allows.
#pragma once

#include <algorithm>

#include "host/base/math.h"

namespace nearlight::core::gltf {

inline Vec3 clamped(Vec3 c) {
    return min(max(c, {0, 0, 0}), {1, 1, 1});
}

inline Vec3 grey(double number) {
    return Vec3{1, 1, 1} * static_cast<float>(std::clamp(number, 0.0, 1.0));
}

}  // namespace nearlight::core::gltf
