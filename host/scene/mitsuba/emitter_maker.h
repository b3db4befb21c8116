// SPDX-License-Identifier: Apache-2.0
// Mitsuba's emitters that are not shapes.
#pragma once

#include "host/scene/mitsuba/texture_maker.h"

namespace nearlight::core::mitsuba {

/// Adds a light that is not part of a shape to the scene. An area light makes no light here: the shape that
/// refers to it does, and if there is none, a note says so.
void add_emitter(const Object& emitter, Scene& scene, TextureMaker& textures, NoteSink& notes);

}  // namespace nearlight::core::mitsuba
