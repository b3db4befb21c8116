// SPDX-License-Identifier: Apache-2.0
// The geometry of Wavefront OBJ files, through tinyobjloader, which only this folder knows.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "host/scene/mesh.h"
#include "host/scene/note_sink.h"
#include "host/scene/obj/obj_extras.h"

namespace nearlight::core {

/// What a file is read as.
enum class ObjUse {
    /// Polygons may have any shape, and smoothing groups and colours of vertices count. A mesh of which no
    /// face has a normal is smooth as the smoothing groups say, or, if the file has no such groups, where
    /// faces meet at a small angle (add_crease_normals()).
    scene,
    /// As Mitsuba reads the file of a shape: polygons are fans; smoothing groups and colours do not count.
    mitsuba_shape,
};

struct ObjFile {
    Mesh mesh;                           ///< its groups are indices into `materials`
    std::vector<std::string> materials;  ///< names after `usemtl`; the first is "", for faces before any
    /// What follows `mtllib`, each once, by its line.
    std::map<int, std::string> libraries;
    std::string text;             ///< of the file, to find lines in, with continued lines joined
    std::size_t short_faces = 0;  ///< faces of fewer than three corners, which were left out
    /// The line of the first face with a normal or texture coordinate that the file does not have before it,
    /// which its corners do without; 0 if there is none.
    int first_lost_attribute = 0;
    OddNumbers odd_numbers{};
    /// Points, lines or free-form surfaces were left out. Always false for shapes of Mitsuba, which leaves
    /// them out, too.
    bool has_other_elements = false;
    std::size_t crooked_faces =
        0;  ///< faces with so many corners that they became fans though they are not convex
};

/// Reads the geometry; negative indices count back. With `mesh`, which is 0 or greater, reads only that one
/// of the meshes that Mitsuba 0.5 and 0.6 make of the file (mesh_starts()), and of `materials` only those
/// that it needs. Throws Error(ErrorKind::file) with file and line for a vertex that is not there, for a file
/// without a triangle, and if there is no such mesh. Files may be read by several threads at once.
ObjFile read_obj(const std::filesystem::path& file, ObjUse use, std::optional<int> mesh = {});

/// Notes what was left out of the file, if anything was.
void note_what_is_left_out(const ObjFile& obj, NoteSink& notes);

}  // namespace nearlight::core
