// SPDX-License-Identifier: Apache-2.0
// Three numbers.
#pragma once

namespace nearlight {

/// A point or vector in metres of the scene's world space, or a linear sRGB colour.
struct Vec3 {
    float x, y, z;
};

}  // namespace nearlight
