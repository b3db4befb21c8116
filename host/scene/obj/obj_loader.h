// SPDX-License-Identifier: Apache-2.0
// Whole scenes of Wavefront OBJ files.
#pragma once

#include <filesystem>

#include "host/scene/scene_loader.h"

namespace nearlight::core {

/// Reads an OBJ file and its materials as a whole scene. A camera is added, and light if nothing emits.
Scene load_obj_scene(const std::filesystem::path& file, const LoadOptions& options);

}  // namespace nearlight::core
