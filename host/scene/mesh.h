// SPDX-License-Identifier: Apache-2.0
// A triangle mesh on its way from a file or a shape into the scene.
#pragma once

#include <array>
#include <filesystem>
#include <span>
#include <vector>

#include "host/base/math.h"
#include "host/scene/note_sink.h"
#include "host/scene/scene.h"

namespace nearlight::core {

struct Mesh {
    std::filesystem::path source;  ///< for messages
    std::vector<Vec3> positions;
    std::vector<Vec3> normals;  ///< one a position, or empty
    std::vector<std::array<float, 2>>
        uvs;  ///< one a position, or empty; v = 0 at the bottom row of a texture
    std::vector<std::array<uint, 3>> triangles;
    std::vector<uint> groups;  ///< one a triangle: index into MeshPlacement::materials; empty: all 0
};

struct MeshPlacement {
    Mat4 to_world;
    std::span<const uint> materials;  ///< at least one, indices into Scene::materials
    bool face_normals = false;        ///< flat, whatever normals the mesh has
    bool flip_normals = false;        ///< turn it inside out
};

/// Adds the mesh to the scene. Without normals it gets smooth ones (weighted by angle). The front of a
/// triangle is the side of its vertex normals where the mesh brought some, otherwise the side from which the
/// transformed corners run counter-clockwise; so it is in Mitsuba 3, mirrored transforms included. Triangles
/// with a NaN or infinite corner are left out, with a note. Throws Error(ErrorKind::file) for an index out of
/// range.
void append_mesh(Scene& scene, const Mesh& mesh, const MeshPlacement& placement, NoteSink& notes);

/// Sum of the normals of the triangles around each position, weighted by their angle there, normalised.
std::vector<Vec3> smooth_normals(std::span<const Vec3> positions,
                                 std::span<const std::array<uint, 3>> triangles);

}  // namespace nearlight::core
