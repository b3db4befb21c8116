// SPDX-License-Identifier: Apache-2.0
// Meshes with morph targets and skins as the nodes of their file stand.
#pragma once

#include <array>
#include <vector>

#include "host/scene/gltf/primitive_data.h"
#include "host/scene/mesh.h"

namespace nearlight::core::gltf {

/// Adds the morph targets with the weights of the node, or else of the mesh, and notes those that are left
/// out.
void apply_morph_targets(const GltfFile& file, const tinygltf::Node& node, const tinygltf::Mesh& source,
                         const tinygltf::Primitive& primitive, Mesh& mesh, NoteSink& notes);

/// The transforms of a skin's joints, from the space of the mesh to the world. Calls fail() if the skin is
/// broken. `world` has the transform of each node of the file.
std::vector<Mat4> joint_transforms(const GltfFile& file, const tinygltf::Skin& skin,
                                   const std::vector<Mat4>& world);

/// Moves the vertices into the world as their joints say. Calls fail() for a joint that is not there.
void apply_skin(const GltfFile& file, const PrimitiveData& data, const std::vector<Mat4>& joints, Mesh& mesh);

}  // namespace nearlight::core::gltf
