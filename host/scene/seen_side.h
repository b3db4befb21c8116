// SPDX-License-Identifier: Apache-2.0
// Which side of a closed surface can be seen.
#pragma once

#include "host/scene/mesh.h"

namespace nearlight::core {

/// Whether the back of a closed surface can be seen from a point. Where the front is outside, the back is
/// seen from inside, as that of a sky box or of a lamp that encloses the room; where the front is inside, the
/// back is seen from outside.
bool shows_back(const Mesh& mesh, const Mat4& to_world, Vec3 eye);

}  // namespace nearlight::core
