// SPDX-License-Identifier: Apache-2.0
// Which side of a closed surface can be seen.
#pragma once

#include "host/scene/mesh.h"
#include "host/scene/scene_overrides.h"

namespace nearlight::core {

/// Where the camera of the scene stands, or where the caller places it.
Vec3 eye_of(const Scene& scene, const SceneOverrides& overrides);

/// Whether the back of a closed surface can be seen from a point: from inside, if its front is outside, as
/// that of a lamp is around which a room was built or of a sky box; from outside, if its front is inside.
bool shows_back(const Mesh& mesh, const Mat4& to_world, Vec3 eye);

}  // namespace nearlight::core
