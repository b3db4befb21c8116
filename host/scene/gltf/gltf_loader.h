// SPDX-License-Identifier: Apache-2.0
// glTF 2.0: .gltf and .glb (through tinygltf, which only this folder knows).
#pragma once

#include <filesystem>

#include "host/scene/scene_loader.h"

namespace nearlight::core {

/// The file's default scene, its first one where it names none. Parameter `camera` chooses a camera by its
/// node's or its own name; else the first is taken, and where there is none one is made up, as light is where
/// nothing emits. Units: metres; lights in candela and lux count 1/683 of that in W, emission is a radiance.
/// Throws Error(ErrorKind::file), or Error(ErrorKind::invalid_argument) for a parameter that there is not.
Scene load_gltf_scene(const std::filesystem::path& file, const LoadOptions& options);

}  // namespace nearlight::core
