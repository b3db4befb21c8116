// SPDX-License-Identifier: Apache-2.0
// Mitsuba's built-in shapes as meshes, in their local space.
#pragma once

#include <optional>

#include "host/scene/mesh.h"

namespace nearlight::core::mitsuba {

/// XY square [−1, 1]², normal +Z.
Mesh rectangle_mesh();
/// [−1, 1]³.
Mesh cube_mesh();
/// Unit disk in XY, normal +Z. The polygon has the area of the circle.
Mesh disk_mesh();
/// Unit sphere, 64 × 128 facets whose area is that of the sphere; smooth normals.
Mesh sphere_mesh();
/// Around +Z from z = 0 to 1, radius 1, open, normals outwards.
Mesh cylinder_mesh();

}  // namespace nearlight::core::mitsuba
