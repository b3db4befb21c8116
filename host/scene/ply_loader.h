// SPDX-License-Identifier: Apache-2.0
// Stanford PLY: ASCII and binary of either byte order.
#pragma once

#include <filesystem>

#include "host/scene/mesh.h"

namespace nearlight::core {

/// Reads positions, normals (nx, ny, nz), texture coordinates (u, v or s, t) and faces, which become fans;
/// other elements and properties are skipped. Mesh::uvs are as in the file. Throws Error(ErrorKind::file) if
/// the file is missing, truncated, not understood or without a triangle.
Mesh read_ply(const std::filesystem::path& file);

}  // namespace nearlight::core
