// SPDX-License-Identifier: Apache-2.0
// Mitsuba's `serialized` files: compressed meshes, several to a file.
#pragma once

#include <filesystem>

#include "host/scene/mesh.h"

namespace nearlight::core::mitsuba {

/// Reads the mesh with the number `index`, counted from 0, from a file of version 3, 4 or 5, with v as in the
/// file. Vertex colours and attributes are skipped. Throws Error(ErrorKind::file) if the file is missing,
/// truncated or not understood, or the mesh has no triangle.
Mesh read_serialized(const std::filesystem::path& file, int index);

}  // namespace nearlight::core::mitsuba
