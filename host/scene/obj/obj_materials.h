// SPDX-License-Identifier: Apache-2.0
// Materials of Wavefront OBJ files (MTL libraries).
#pragma once

#include <vector>

#include "host/scene/obj/obj_file.h"

namespace nearlight::core {

/// Adds the materials that the file uses to the scene. The result holds the index of each of
/// ObjFile::materials; what is not defined is grey.
std::vector<uint> add_obj_materials(Scene& scene, const ObjFile& obj, NoteSink& notes);

}  // namespace nearlight::core
