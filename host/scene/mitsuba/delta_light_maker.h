// SPDX-License-Identifier: Apache-2.0
// Mitsuba's emitters that light from a point or a direction: point, spot, projector, directional.
#pragma once

#include <optional>

#include "host/scene/mitsuba/texture_maker.h"

namespace nearlight::core::mitsuba {

/// The colour called `name` that the emitter sends, 1 if it has none; calls fail() for a negative one.
Vec3 emitted_color(const Object& emitter, const char* name, TextureMaker& textures);

/// The light, or nothing if the emitter is of another type.
std::optional<Emitter> make_delta_light(const Object& emitter, const Scene& scene, TextureMaker& textures,
                                        NoteSink& notes);

}  // namespace nearlight::core::mitsuba
