// SPDX-License-Identifier: Apache-2.0
// glTF 2.0: .gltf and .glb (through tinygltf, which only this folder knows).
#pragma once

#include <filesystem>

#include "host/scene/scene_loader.h"

namespace nearlight::core {

/// Reads the file's default scene, or its first one if it names none. Cameras have their own and their nodes'
/// names. A camera is added if there is none, and a neutral sky if nothing is there to light the scene. The
/// unit is the metre; lights in candela and lux count 1/683 of that in W, and emission is a radiance. Throws
/// Error(ErrorKind::file), or Error(ErrorKind::invalid_argument) for an unknown parameter or camera.
Scene load_gltf_scene(const std::filesystem::path& file, const LoadOptions& options);

}  // namespace nearlight::core
