// SPDX-License-Identifier: Apache-2.0
// Stanford PLY: ASCII and binary of either byte order.
#pragma once

#include <filesystem>
#include <string_view>

#include "host/scene/mesh.h"

namespace nearlight::core {

/// Reads positions, normals (nx, ny, nz), texture coordinates (u, v or s, t) and faces, which may be polygons
/// of any shape; other elements and properties are skipped. Mesh::uvs are as in the file. `attribute` says
/// which colours or numbers become Mesh::colors, if it is vertex_NAME, or Mesh::face_colors, if it is
/// face_NAME: as Mitsuba writes them, one or three properties that are called NAME_ and one more character (x
/// y z, r g b, 0 1 2 or 1 2 3); for the name color also r, g, b or red, green, blue. A single number becomes
/// a grey. Throws Error(ErrorKind::file) if the file is missing, truncated, not understood or without a
/// triangle.
Mesh read_ply(const std::filesystem::path& file, std::string_view attribute = "vertex_color");

}  // namespace nearlight::core
