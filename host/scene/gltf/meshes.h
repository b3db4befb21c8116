// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/scene/gltf/gltf_file.h"
#include "host/scene/gltf/materials.h"
#include "host/scene/mesh.h"

namespace nearlight::core::gltf {

/// Adds the triangles of the node's mesh, if it has one, without skin or morphing. Points and lines are left
/// out, with a note.
void add_mesh(const GltfFile& file, const tinygltf::Node& node, const Mat4& to_world,
              MaterialMaker& materials, Scene& scene, NoteSink& notes);

}  // namespace nearlight::core::gltf
