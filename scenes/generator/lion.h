// SPDX-License-Identifier: Apache-2.0
// A seated guardian lion of stone, like those in front of temples and palaces.
#pragma once

#include "scenes/generator/mesh.h"

namespace nearlight::core::scenes {

/// A lion about 0.95 m high that sits on y = 0 and looks along +z. `cell` (m) is the edge length of its
/// triangles.
Mesh make_guardian_lion(float cell);

}  // namespace nearlight::core::scenes
