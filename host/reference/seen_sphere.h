// SPDX-License-Identifier: Apache-2.0
// Directions to a shining sphere, uniform over the solid angle under which it is seen, in double precision.
#pragma once

#include "host/reference/sampling.h"
#include "kernels/shared/light.h"

namespace nearlight::core {

class SeenSphere {
  public:
    /// The light, a sphere of the table of lights, seen from `position`.
    SeenSphere(const Emitter& light, Vec3 position);

    /// Whether the position lies outside.
    [[nodiscard]] bool is_seen() const { return sine_ > 0.0; }
    /// Steradians; 0 where the position lies no farther from the centre than the sphere's triangles do.
    [[nodiscard]] double solid_angle() const;
    /// A unit vector, uniform over the solid angle, which must be greater than 0.
    [[nodiscard]] Vec3 sample(Point2 u) const;
    /// Density of sample() in a unit direction, per steradian.
    [[nodiscard]] double density(Vec3 direction) const;
    /// The first point in a direction of sample() that is as near to the centre as the sphere's triangles
    /// are.
    [[nodiscard]] Vec3 entry(Vec3 direction) const;
    /// The unit vector from the centre to a point.
    [[nodiscard]] Vec3 outwards(Vec3 point) const { return normalize(point - (position_ + to_center_)); }

  private:
    Vec3 position_, to_center_;
    double radius_, outer_radius_;
    double distance_;
    double sine_ = 0.0;  ///< of the half angle of the cone
    double cosine_ = 1.0;
};

}  // namespace nearlight::core
