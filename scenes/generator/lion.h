// SPDX-License-Identifier: Apache-2.0
// A guardian lion of stone, seated, after those that sit before temples and palaces.
#pragma once

#include "scenes/generator/mesh.h"

namespace nearlight::core::scenes {

/// Sits on y = 0 and looks along +z, about 0.95 high; `cell` is the edge length of its triangles.
Mesh make_guardian_lion(float cell);

}  // namespace nearlight::core::scenes
