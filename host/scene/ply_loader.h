// SPDX-License-Identifier: Apache-2.0
// Stanford PLY: ASCII and binary of either byte order.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "host/scene/mesh.h"
#include "host/scene/ply_columns.h"

namespace nearlight::core {

/// The attribute of a file that becomes the colours of a mesh.
struct PlyAttribute {
    std::string_view name = "vertex_color";
    PlyCode code = PlyCode::as_it_stands;
};

/// Reads positions, normals (nx, ny, nz), texture coordinates (u and v, or else texture_u and texture_v, or
/// else s and t), faces, which may be polygons of any shape, and strips of triangles (tristrips), in any
/// order; other elements and properties are skipped. Mesh::uvs are as in the file. The attribute says which
/// colours or numbers become Mesh::colors, if it is vertex_NAME, or Mesh::face_colors, if it is face_NAME: as
/// Mitsuba writes them, one or three properties that are called NAME_ and one more character (x y z, r g b, 0
/// 1 2 or 1 2 3); for the name color also r, g, b or red, green, blue. A single number becomes a grey. Throws
/// Error(ErrorKind::file) if the file is missing, truncated, not understood or without a triangle.
Mesh read_ply(const std::filesystem::path& file, const PlyAttribute& attribute = {});

/// What a file says that is a scene by itself.
struct PlyModel {
    /// Its colours are not decoded (PlyCode::display). If there are textures and coordinates for them,
    /// Mesh::groups has 0 for triangles without a texture, and for others 1 + the number of theirs.
    Mesh mesh;
    std::vector<std::string> textures;   ///< names of image files
    bool are_textures_numbered = false;  ///< the faces say which one they have
    bool has_colors_of_both = false;     ///< of vertices, which are the mesh's, and of faces
};

/// Reads a file with the names of its textures, which MeshLab and others write into comments ("TextureFile
/// NAME"), and with the texture coordinates of corners (a list `texcoord` of faces), which count more than
/// those of vertices. Throws as read_ply() does.
PlyModel read_ply_model(const std::filesystem::path& file);

}  // namespace nearlight::core
