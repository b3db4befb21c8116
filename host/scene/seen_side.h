// SPDX-License-Identifier: Apache-2.0
// Which side of a closed surface can be seen.
#pragma once

#include "host/scene/mesh.h"

namespace nearlight::core {

/// Whether the back of a closed surface can be seen from a point: from inside, if its front is outside, as
/// that of a lamp is around which a room was built or of a sky box; from outside, if its front is inside.
bool shows_back(const Mesh& mesh, const Mat4& to_world, Vec3 eye);

}  // namespace nearlight::core
