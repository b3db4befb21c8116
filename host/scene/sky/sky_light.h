// SPDX-License-Identifier: Apache-2.0
// A clear sky with its sun as an environment.
#pragma once

#include "host/scene/scene.h"

namespace nearlight::core {

/// The angle under which the sun is seen from the Earth, degrees.
inline constexpr double kSunAperture = 0.5358;

struct SkyLight {
    double turbidity = 3.0;         ///< 1 to 10
    Vec3 albedo{0.3f, 0.3f, 0.3f};  ///< of the ground, 0 to 1
    Vec3 sun{0, 0, 1};              ///< unit vector to the sun in the model's frame, +Z up; z is not negative
    double sky_scale = 1.0;         ///< 0: no sky
    double sun_scale = 1.0;         ///< 0: no sun
    double sun_half_angle = kSunAperture * kPi / 360.0;  ///< radians
};

/// The transform from the map of a sky (+Y up) to the model's frame (+Z up).
Mat4 sky_map_to_model();

/// Sets the map and the sun of an environment whose `to_world` is that of the map. Without a sky the map is
/// one black pixel.
void set_sky(EnvironmentLight& light, const SkyLight& sky);
/// Sets the sun alone, given the unit vector to it in the world.
void set_sun(EnvironmentLight& light, const SkyLight& sky, Vec3 to_sun);

}  // namespace nearlight::core
