// SPDX-License-Identifier: Apache-2.0
// glTF 2.0: .gltf and .glb (through tinygltf, which only this folder knows).
#pragma once

#include <filesystem>
#include <optional>

#include "host/scene/scene_loader.h"

namespace nearlight::core {

/// Reads the file's default scene, or its first one if it names none. Cameras have their own and their nodes'
/// names. If the file has no camera, one is added that frames the nodes at rest; if nothing lights the scene,
/// a neutral sky is added. The unit is the metre; lights in candela and lux count 1/683 of that in W, and
/// emission is a radiance. Throws Error(ErrorKind::file), or Error(ErrorKind::invalid_argument) for an
/// unknown parameter, camera or animation.
Scene load_gltf_scene(const std::filesystem::path& file, const LoadOptions& options);

/// The camera of a file at a moment.
struct GltfCameras {
    std::optional<SceneCamera> own{};  ///< empty if the file has none
};
/// The camera that the file of `scene` has at the moment of the options; nothing if nodes with surfaces or
/// lights stand elsewhere than in `scene`. Throws as load_gltf_scene().
std::optional<GltfCameras> gltf_cameras_of(const Scene& scene, const LoadOptions& options);

}  // namespace nearlight::core
