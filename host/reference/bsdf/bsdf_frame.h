// SPDX-License-Identifier: Apache-2.0
// The frame in which BSDFs are evaluated.
#pragma once

#include "host/base/vec3d.h"

namespace nearlight::core {

/// The unit vector w mirrored about the unit vector m; both point away from the surface.
constexpr Vec3d mirrored(Vec3d w, Vec3d m) {
    return m * (2 * dot(w, m)) - w;
}

/// Three orthonormal vectors; n is the normal. They may be left-handed.
struct BsdfFrame {
    Vec3d s, t, n;

    [[nodiscard]] Vec3d to_world(Vec3d v) const { return s * v.x + t * v.y + n * v.z; }
    [[nodiscard]] Vec3d to_local(Vec3d v) const { return {dot(v, s), dot(v, t), dot(v, n)}; }
};

}  // namespace nearlight::core
