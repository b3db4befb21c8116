// SPDX-License-Identifier: Apache-2.0
// Which of a mesh file's own colours and numbers the textures of a shape look up.
#pragma once

#include <string>

#include "host/scene/mitsuba/object.h"

namespace nearlight::core::mitsuba {

/// What a texture without a name of its own looks up.
inline constexpr const char* kVertexColor = "vertex_color";

/// Whether the texture looks an attribute of the mesh up.
bool is_mesh_attribute(const Object& texture);

/// The attribute that textures of the shape's bsdf and emitter look up, "vertex_" or "face_" and a name;
/// kVertexColor if none does. Marks nothing as used. Calls fail() if there are two, because a mesh keeps
/// one.
std::string mesh_attribute_of(const Object& shape);

}  // namespace nearlight::core::mitsuba
