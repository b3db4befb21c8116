// SPDX-License-Identifier: Apache-2.0
// Mitsuba's built-in shapes as meshes, in their local space.
#pragma once

#include <optional>

#include "host/scene/mesh.h"

namespace nearlight::core::mitsuba {

/// The square [−1, 1]² in the XY plane, normal +Z.
Mesh rectangle_mesh();
/// The cube [−1, 1]³.
Mesh cube_mesh();
/// The unit disk in the XY plane, normal +Z. The polygon has the area of the circle.
Mesh disk_mesh();
/// The unit sphere with smooth normals, as 64 × 128 facets whose area is that of the sphere.
Mesh sphere_mesh();
/// The open cylinder of radius 1 around the Z axis from z = 0 to 1, normals outwards.
Mesh cylinder_mesh();

}  // namespace nearlight::core::mitsuba
