// SPDX-License-Identifier: Apache-2.0
// The backs of surfaces that shine: the order of the corners of OBJ files says nothing of fronts.
#pragma once

#include <vector>

#include "host/scene/mesh.h"

namespace nearlight::core {

/// Lets surfaces that shine do so to both sides; closed ones only to the side that is seen from `eye`. The
/// mesh, whose groups have these materials, is in the scene already.
void add_lamp_backs(Scene& scene, const Mesh& mesh, const std::vector<uint>& materials, Vec3 eye,
                    NoteSink& notes);

}  // namespace nearlight::core
