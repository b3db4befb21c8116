// SPDX-License-Identifier: Apache-2.0
// Which images the materials of an OBJ file show.
#pragma once

#include <string>
#include <vector>

#include "host/scene/image_reader.h"
#include "host/scene/obj/mtl_file.h"

namespace nearlight::core {

/// The images of the textures that most entries use, in the order of the materials. `owners` are the
/// libraries that have the entries of these names; null: nothing defines the material.
std::vector<ImageSource> images_of(const std::vector<std::string>& names,
                                   const std::vector<const MaterialLibrary*>& owners);

}  // namespace nearlight::core
