// SPDX-License-Identifier: Apache-2.0
// What a scene may hold so that 32-bit floats can still add up its light and tell its surfaces apart.
#pragma once

#include "host/scene/note_sink.h"
#include "host/scene/scene.h"

namespace nearlight::core {

/// Radiances, intensities and irradiances are at most this, because sums over lights, pixels and directions
/// must stay finite.
inline constexpr float kMaxRadiance = 1e20f;

/// Darkens lights to kMaxRadiance, and notes it once as an approximation. Remarks a scene that lies so far
/// from the origin that rays would start visibly off its surfaces (ray_epsilon.h).
void keep_within_limits(Scene& scene, NoteSink& notes);

}  // namespace nearlight::core
