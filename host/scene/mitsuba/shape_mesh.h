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
/// Rows of facets of the finest sphere.
inline constexpr uint kFinestStacks = 64;
/// The unit sphere with smooth normals, as stacks × 2 stacks facets whose area is that of the sphere. There
/// are at least 2 stacks.
Mesh sphere_mesh(uint stacks = kFinestStacks);
/// How many triangles that sphere has.
constexpr std::size_t sphere_triangle_count(uint stacks) {
    return std::size_t{4} * stacks * (stacks - 1);
}
/// The open cylinder of radius 1 around the Z axis from z = 0 to 1, normals outwards.
Mesh cylinder_mesh();

}  // namespace nearlight::core::mitsuba
