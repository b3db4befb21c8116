// SPDX-License-Identifier: Apache-2.0
// The colours of vertices once a scene is complete.
#pragma once

#include <span>

#include "host/base/math.h"
#include "host/scene/note_sink.h"

namespace nearlight::core {

/// Makes linear colours of those that programs for looking at meshes write: sRGB, as whole numbers up to 255,
/// or as numbers up to 1. kNoColor stays.
void decode_display_colors(std::span<Vec3> colors);

/// Drops the colours of vertices if no texture asks for them. Otherwise missing colours become white, with a
/// note if a surface asks for one, and colours that make a surface reflect more than all light are noted.
void finish_vertex_colors(Scene& scene, NoteSink& notes);

}  // namespace nearlight::core
