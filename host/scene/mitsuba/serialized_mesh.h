// SPDX-License-Identifier: Apache-2.0
// Mitsuba's `serialized` files: compressed meshes, several to a file.
#pragma once

#include <filesystem>

#include "host/scene/mesh.h"

namespace nearlight::core::mitsuba {

/// Reads the mesh with the number `index`, counted from 0, from a file of version 3, 4 or 5, with v and the
/// colours of vertices as in the file. Files of version 5 have no such colours; what else they have is
/// skipped. Other meshes of the file are not read. Throws Error(ErrorKind::file) if the file is missing,
/// truncated or not understood, or the mesh has no triangle.
Mesh read_serialized(const std::filesystem::path& path, int index);

}  // namespace nearlight::core::mitsuba
