// SPDX-License-Identifier: Apache-2.0
// The colours of vertices once a scene is complete.
#pragma once

#include "host/scene/note_sink.h"

namespace nearlight::core {

/// Drops the colours of vertices if no texture asks for them. Otherwise missing colours become white, with a
/// note if a surface asks for one, and colours that make a surface reflect more than all light are noted.
void finish_vertex_colors(Scene& scene, NoteSink& notes);

}  // namespace nearlight::core
