// SPDX-License-Identifier: Apache-2.0
// Whole scenes of PLY files.
#pragma once

#include <filesystem>

#include "host/scene/scene_loader.h"

namespace nearlight::core {

/// Reads a PLY file as a whole scene: grey, or of its vertices' colours, which count as sRGB, or of its
/// textures. Without normals, surfaces are smooth where faces meet at a small angle (add_crease_normals()). A
/// camera and light are added.
Scene load_ply_scene(const std::filesystem::path& file, const LoadOptions& options);

}  // namespace nearlight::core
