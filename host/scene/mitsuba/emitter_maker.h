// SPDX-License-Identifier: Apache-2.0
// Mitsuba's emitters that are not shapes.
#pragma once

#include "host/scene/mitsuba/texture_maker.h"

namespace nearlight::core::mitsuba {

/// Adds a point, spot, constant or envmap light to the scene.
void add_emitter(const Object& emitter, Scene& scene, TextureMaker& textures, NoteSink& notes);

}  // namespace nearlight::core::mitsuba
