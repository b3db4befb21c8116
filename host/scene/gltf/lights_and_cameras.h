// SPDX-License-Identifier: Apache-2.0
// KHR_lights_punctual, and cameras.
#pragma once

#include <string>
#include <vector>

#include "host/scene/gltf/gltf_file.h"
#include "host/scene/scene.h"

namespace nearlight::core::gltf {

/// Each as it stands in the scene; it looks along the −Z of its node.
struct PlacedLight {
    const tinygltf::Light* light = nullptr;
    Mat4 to_world;
};
struct PlacedCamera {
    const tinygltf::Camera* camera = nullptr;
    std::string node;  ///< its name
    Mat4 to_world;
};

/// Of a quaternion x, y, z, w; any length.
Mat4 rotation_of(const std::vector<double>& quaternion);

/// Adds what the node has to a list.
void find_light(const GltfFile& file, const tinygltf::Node& node, const Mat4& to_world,
                std::vector<PlacedLight>& lights);
void find_camera(const GltfFile& file, const tinygltf::Node& node, const Mat4& to_world,
                 std::vector<PlacedCamera>& cameras);

/// Points, spots, and directional lights, which become spots far away; once all surfaces are in the scene.
void add_lights(const GltfFile& file, const std::vector<PlacedLight>& lights, Scene& scene, NoteSink& notes);

/// The first, or the one whose node or camera has the name. Throws Error(ErrorKind::invalid_argument) for a
/// name that there is not.
SceneCamera choose_camera(const GltfFile& file, const std::vector<PlacedCamera>& cameras,
                          const std::string& name);

}  // namespace nearlight::core::gltf
