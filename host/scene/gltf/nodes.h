// SPDX-License-Identifier: Apache-2.0
// The nodes of a file, and where they stand.
#pragma once

#include <vector>

#include "host/scene/gltf/gltf_file.h"

namespace nearlight::core::gltf {

/// A node that is part of the scene.
struct PlacedNode {
    int index = 0;  ///< into Model::nodes
    Mat4 to_world;
    /// The rotations of the node and of those above it, without their scales. Cameras stand so.
    Mat4 turn;
};

/// The transform of a node to its parent. Calls fail() if it is not finite.
Mat4 transform_of(const GltfFile& file, const tinygltf::Node& node);

/// The nodes of the default scene, or of the first one, parents before their children; without scenes, all
/// nodes. Hidden ones (KHR_node_visibility) and those below them are left out. Calls fail() if a node has two
/// parents, because nodes that share children could make any number of copies from a small file.
std::vector<PlacedNode> place_nodes(const GltfFile& file);

/// Where each node of the file stands, whether it is part of the scene or not.
std::vector<Mat4> world_transforms(const GltfFile& file);

}  // namespace nearlight::core::gltf
