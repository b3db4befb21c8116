// SPDX-License-Identifier: Apache-2.0
// The fronts of triangles, which glTF gives by the order of their corners, and a Mesh by its normals.
#pragma once

#include <vector>

#include "host/scene/mesh.h"

namespace nearlight::core::gltf {

/// For each triangle, whether it winds against the normals of its corners; empty if none does, as in nearly
/// all files.
std::vector<bool> triangles_against_normals(const Mesh& mesh);

/// Turns the normals of these triangles. Vertices that they share with others are doubled.
void turn_normals(Mesh& mesh, const std::vector<bool>& triangles);

}  // namespace nearlight::core::gltf
