// SPDX-License-Identifier: Apache-2.0
// What OBJ files say beyond tinyobjloader's callbacks.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "host/base/math.h"

namespace nearlight::core {

/// Takes away the byte order mark with which some editors begin UTF-8 text. Makes each line end with a line
/// feed, as carriage returns alone end lines too, and joins lines that end with a backslash with the next
/// ones, unless they are comments. Later lines keep their numbers. Takes away comments behind what a line
/// says of faces, vertices and smoothing, and slashes behind which a face has no number, as in `f 1// 2//
/// 3//`.
void tidy_lines(std::string& text);

/// Faces from `first_face` on, counted from 0, belong to this group of `s` lines; 0 is none.
struct SmoothingRun {
    std::size_t first_face;
    uint group;
};
/// The groups of a file in its order; empty if it has no `s` line.
std::vector<SmoothingRun> smoothing_runs(std::string_view text);

/// The first face of each mesh that Mitsuba 0.5 and 0.6 make of a file, counted from 0 as above. Where faces
/// have come before, a line `g` or `usemtl` begins the next mesh.
std::vector<std::size_t> mesh_starts(std::string_view text);

/// Lines of coordinates, normals and texture coordinates that have fewer numbers than they need, or something
/// else than decimal numbers, such as 1,5 or nan.
struct OddNumbers {
    std::size_t lines = 0;
    int first_line = 0;
};
OddNumbers odd_numbers(std::string_view text);

/// The colours that follow the coordinates of vertices, as in `v x y z r g b`, from sRGB, in which programs
/// write them, to linear. Empty unless all vertices have one.
std::vector<Vec3> vertex_colors(std::string_view text);

}  // namespace nearlight::core
