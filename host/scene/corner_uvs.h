// SPDX-License-Identifier: Apache-2.0
// Texture coordinates of meshes whose files have them at the corners of faces.
#pragma once

#include <array>
#include <span>

#include "host/scene/mesh.h"

namespace nearlight::core {

/// Gives the corners of triangles these texture coordinates, three for each triangle, in place of those that
/// the mesh may have. They are finite. A vertex becomes several where its corners differ, and vertices
/// without a triangle are left out.
void set_corner_uvs(Mesh& mesh, std::span<const std::array<float, 2>> uvs);

}  // namespace nearlight::core
