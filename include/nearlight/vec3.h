// SPDX-License-Identifier: Apache-2.0
// Vectors and colours of three components.
#pragma once

namespace nearlight {

/// A point or vector in metres of the scene's world space, or a linear sRGB colour.
struct Vec3 {
    float x, y, z;

    friend bool operator==(const Vec3&, const Vec3&) = default;
};

}  // namespace nearlight
