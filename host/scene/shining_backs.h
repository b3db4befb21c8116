// SPDX-License-Identifier: Apache-2.0
// Surfaces that shine to both sides, because triangles shine with their front only.
#pragma once

#include <span>

#include "host/scene/mesh.h"

namespace nearlight::core {

/// The material of the back of a surface that shines. Diffuse and two-sided surfaces have their own on the
/// back, too. Others get one that only shines and lets the rest through, because their maps and what they do
/// to light that passes belong to the front.
uint add_back_material(Scene& scene, uint front);

/// Adds the back of a surface that shines to both sides. It stands behind the front, at a distance that rays
/// can tell.
void add_shining_back(Scene& scene, Mesh mesh, const Mat4& to_world, std::span<const uint> materials,
                      NoteSink& notes);

}  // namespace nearlight::core
