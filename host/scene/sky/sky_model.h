// SPDX-License-Identifier: Apache-2.0
// A clear sky and its sun, as Mitsuba 3's `sunsky` has them in RGB. The frame is that of the plugin: +Z is
// up. For sun_direction(), +X is south and +Y is west, although Mitsuba's manual calls +X north.
#pragma once

#include <array>

#include "host/base/math.h"

namespace nearlight::core {

/// Radiance of the sky by the model of Hosek and Wilkie (2012).
class SkyModel {
  public:
    /// Turbidity is in [1, 10], the ground's albedo in [0, 1], and the sun's elevation in [0, π/2].
    SkyModel(double turbidity, Vec3 albedo, double sun_elevation);

    /// Radiance in a direction with the cosine `cos_zenith` ≥ 0 to the zenith, at the angle `gamma` from the
    /// sun. It is not negative.
    [[nodiscard]] Vec3 radiance(double cos_zenith, double gamma) const;

  private:
    std::array<std::array<double, 9>, 3> parameters_{};
    std::array<double, 3> mean_{};
};

/// Irradiance of the sun across its direction, W/m² in Mitsuba's scale of colours; not negative.
Vec3 sun_irradiance(double turbidity, double sun_elevation);

/// A place on Earth (degrees, hours east of Greenwich) and a local time.
struct PlaceAndTime {
    double latitude = 35.6894, longitude = 139.6917, timezone = 9;
    int year = 2010, month = 7, day = 10;
    double hour = 15, minute = 0, second = 0;
};
/// The unit vector to the sun [Blanco-Muriel et al., Computing the Solar Vector, 2001].
Vec3 sun_direction(const PlaceAndTime& when);

}  // namespace nearlight::core
