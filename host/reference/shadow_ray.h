// SPDX-License-Identifier: Apache-2.0
// Shadow rays of the reference path tracer, which pass straight through veils.
#pragma once

#include "host/base/vec3d.h"
#include "host/reference/light_sampler.h"

namespace nearlight::core {

/// What remains of light on its way.
struct ShadowRay {
    Vec3d transmittance;  ///< 0 where something is in the way
    int veils = 0;        ///< that the ray passed
};

/// What remains at the position of the light that was picked, where a path has room for `max_veils` more
/// surfaces; NEARLIGHT_MAX_VEILS are passed at most. Veils (see veil_transmittance()) block delta lights
/// unless the scene has clear glass or open veils.
ShadowRay shadow_ray(const Scene& scene, const EmbreeScene& embree, Vec3 position, const LightPick& pick,
                     int max_veils, Vec3 scene_size);

}  // namespace nearlight::core
