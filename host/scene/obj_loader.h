// SPDX-License-Identifier: Apache-2.0
// Wavefront OBJ (through tinyobjloader, which only obj_loader.cpp and obj_materials.cpp know).
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "host/scene/mesh.h"
#include "host/scene/scene_loader.h"

namespace nearlight::core {

struct ObjFile {
    Mesh mesh;                             ///< its groups are indices into `materials`
    std::vector<std::string> materials;    ///< names after `usemtl`; the first is "", for faces before any
    std::map<int, std::string> libraries;  ///< names after `mtllib` by their lines, each once
    std::string text;                      ///< text of the file, to find lines in; empty unless kept
    std::size_t short_faces = 0;           ///< faces of fewer than three corners, which were left out
};

/// Reads the geometry: polygons become fans, and negative indices count back. Throws Error(ErrorKind::file)
/// with file and line for an index out of range, and for a file without a triangle. Files may be read by
/// several threads at once.
ObjFile read_obj(const std::filesystem::path& file, bool keep_text = false);

/// Notes that faces of the mesh's file were left out, if any were.
void note_short_faces(const Mesh& mesh, std::size_t short_faces, NoteSink& notes);

/// Reads an OBJ file and its materials as a whole scene. A camera is added, and light if nothing emits.
Scene load_obj_scene(const std::filesystem::path& file, const LoadOptions& options);

}  // namespace nearlight::core
