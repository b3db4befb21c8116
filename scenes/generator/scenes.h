// SPDX-License-Identifier: Apache-2.0
// The scenes, each with its meshes by part and its bitmaps by name.
#pragma once

#include <map>
#include <string>

#include "scenes/generator/files.h"
#include "scenes/generator/mesh.h"

namespace nearlight::core::scenes {

struct SceneFiles {
    Model model;                            ///< geometry/PART.ply
    std::map<std::string, Bitmap> bitmaps;  ///< geometry/NAME.ppm
};

SceneFiles make_cornell_box();
SceneFiles make_desk();
/// `detail` divides the edge lengths of the figure's triangles: 2 gives four times as many.
SceneFiles make_stone_and_tea(float detail);
SceneFiles make_showcase();

}  // namespace nearlight::core::scenes
