// SPDX-License-Identifier: Apache-2.0
// What the lights of a scene bring to a point, one by one.
#pragma once

#include <cstddef>

#include "nearlight/vec3.h"

namespace nearlight {

enum class LightKind { vpl, area, point, spot, projector, directional, sun, environment };

/// What one VPL or emitter brings to a point. Any surface in between takes all of it away, also one that lets
/// light through.
struct LightShare {
    LightKind kind = LightKind::vpl;
    /// VPLs: the place in VplSet::lights(). Emitters: their place among the emitters, where all triangles of
    /// an area light that share vertices count as one.
    std::size_t index = 0;
    /// The middle of the light in metres. Of lights without a place, the unit vector towards them; of the
    /// environment, zero.
    Vec3 position{};
    Vec3 irradiance{};  ///< in W/m²; of a VPL, what it brings under the clamp radius
    /// In W/m²: what the clamp radius takes away from a VPL. Rays of receivers bring it back, if they may.
    Vec3 taken_by_clamp{};
};

}  // namespace nearlight
