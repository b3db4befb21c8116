// SPDX-License-Identifier: Apache-2.0
// The lights of KHR_lights_punctual, and cameras.
#pragma once

#include <string>
#include <vector>

#include "host/scene/gltf/gltf_file.h"
#include "host/scene/gltf/nodes.h"
#include "host/scene/scene.h"

namespace nearlight::core::gltf {

/// A light as it stands in the scene; it points along the −Z axis of its node.
struct PlacedLight {
    const tinygltf::Light* light = nullptr;
    Mat4 to_world;
    Mat4 turn;  ///< without scales
};
/// A camera as it stands in the scene; it looks along the −Z axis of its node. No scale changes it.
struct PlacedCamera {
    const tinygltf::Camera* camera = nullptr;
    std::string node;  ///< name of its node
    Mat4 to_world;     ///< without scale, unless the matrix of a node is singular
};

/// Adds the node's light, if it has one, to `lights`.
void find_light(const GltfFile& file, const PlacedNode& placed, std::vector<PlacedLight>& lights);
/// Adds the node's camera, if it has one, to `cameras`.
void find_camera(const GltfFile& file, const PlacedNode& placed, std::vector<PlacedCamera>& cameras);

/// Adds the lights in the order of their nodes.
void add_lights(const GltfFile& file, const std::vector<PlacedLight>& lights, Scene& scene, NoteSink& notes);

/// The camera that `wanted` chooses (named_choice.h) by the names of its node and its own. Throws
/// Error(ErrorKind::invalid_argument) if there is no such camera.
SceneCamera choose_camera(const GltfFile& file, const std::vector<PlacedCamera>& cameras,
                          const std::string& wanted);

}  // namespace nearlight::core::gltf
