// SPDX-License-Identifier: Apache-2.0
// A triangle mesh on its way from a file or a shape into the scene.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "host/base/math.h"
#include "host/scene/note_sink.h"
#include "host/scene/scene.h"

namespace nearlight::core {

/// Stands for a missing colour of a vertex while scenes are loaded.
inline constexpr Vec3 kNoColor{-1, -1, -1};

struct Mesh {
    std::filesystem::path source;  ///< the file, for messages
    std::vector<Vec3> positions;
    std::vector<Vec3> normals;  ///< one a position, or empty
    /// One for each position, or empty; v = 0 at the bottom row of a texture.
    std::vector<std::array<float, 2>> uvs;
    std::vector<std::array<float, 2>> second_uvs;  ///< for Scene::second_uvs; one a position, or empty
    std::vector<Vec3> colors;                      ///< linear sRGB, one a position, or empty
    std::vector<std::array<uint, 3>> triangles;
    std::vector<Vec3> face_colors;  ///< linear sRGB, one a triangle, or empty; then `colors` do not count
    bool face_normals = false;      ///< the file asks for flat facets
    std::vector<std::string> object_names;  ///< of the objects that the file says the mesh consists of
    std::vector<ObjectRun> objects;         ///< in the order of triangles; empty: the mesh is one object
    std::vector<uint> groups;  ///< one a triangle: index into MeshPlacement::materials; empty: all 0
};

struct MeshPlacement {
    Mat4 to_world;
    std::span<const uint> materials;  ///< at least one, indices into Scene::materials
    bool face_normals = false;        ///< flat facets, whatever normals the mesh has
    bool flip_normals = false;        ///< turn the mesh inside out
    /// Give each triangle the texture coordinates that Mitsuba takes for a mesh without any: the barycentric
    /// ones of its second and third corner.
    bool corner_uvs = false;
};

/// Adds the mesh to the scene. A mesh without normals gets smooth ones, weighted by angle. As in Mitsuba 3,
/// the front of a triangle is the side of its vertex normals if the mesh has any, otherwise the side from
/// which the transformed corners run counter-clockwise, even if the transform mirrors. Triangles with a NaN
/// or infinite corner are left out, with a note. Colours of vertices are kept; vertices without one get
/// kNoColor, which finish_vertex_colors() replaces; with colours of faces each triangle gets vertices of its
/// own. Objects that the mesh has begin in the scene. Throws Error(ErrorKind::file) for an index out of
/// range.
void append_mesh(Scene& scene, const Mesh& mesh, const MeshPlacement& placement, NoteSink& notes);

/// The unit normal of a surface that m transforms, where n was its normal; `sign` is −1 where m mirrors, so
/// that the normal stays on its side. 0 if it is lost.
Vec3 transform_normal(const Mat4& m, double sign, Vec3 n);

/// Whether the surface, or that of the triangles of a group, has no border, and therefore no back that could
/// be seen. Corners at the same place count as one.
bool is_closed(const Mesh& mesh, std::optional<uint> group = {});

/// Whether the corners of a triangle run clockwise as seen from the side of their normals, which are of
/// length 1.
bool winds_against(const std::array<uint, 3>& triangle, std::span<const Vec3> positions,
                   std::span<const Vec3> normals);

/// Throws Error(ErrorKind::file) for an index out of range, and if normals, colours or texture coordinates
/// are not as many as positions.
void check_mesh(const Mesh& mesh);

/// The unit normal at each position: the sum of the normals of the triangles around it, weighted by their
/// angles there.
std::vector<Vec3> smooth_normals(std::span<const Vec3> positions,
                                 std::span<const std::array<uint, 3>> triangles);

}  // namespace nearlight::core
