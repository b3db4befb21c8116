// SPDX-License-Identifier: Apache-2.0
// Surfaces that shine to both sides, because triangles shine with their front only.
#pragma once

#include <span>

#include "host/scene/mesh.h"

namespace nearlight::core {

/// The material of the back of a surface that shines. That of a plain opaque surface is the same; others get
/// one that only shines, because their light passes through, and their maps are seen on, the fronts.
uint add_back_material(Scene& scene, uint front);

/// Adds the back of a surface that shines to both sides. It stands behind the front, at a distance that rays
/// can tell.
void add_shining_back(Scene& scene, Mesh mesh, const Mat4& to_world, std::span<const uint> materials,
                      NoteSink& notes);

}  // namespace nearlight::core
