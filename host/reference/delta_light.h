// SPDX-License-Identifier: Apache-2.0
// Delta lights in the reference path tracer: point lights, spots, projectors and directional lights.
#pragma once

#include "host/scene/scene.h"

namespace nearlight::core {

/// What a delta light sends to a place, before visibility.
struct DeltaLight {
    Vec3 direction{0, 0, 1};   ///< unit vector towards the light
    Vec3 irradiance{0, 0, 0};  ///< across that direction, W/m²
    bool infinite = false;     ///< the light comes from infinitely far away
};
DeltaLight delta_light_at(const Scene& scene, const Emitter& emitter, Vec3 position);

}  // namespace nearlight::core
