// SPDX-License-Identifier: Apache-2.0
// Directions to a shining cylinder, by an angle φ across its axis and an elevation α along it, both uniform,
// in double precision.
#pragma once

#include "host/base/vec3d.h"
#include "host/reference/sampling.h"
#include "kernels/shared/light.h"

namespace nearlight::core {

class SeenCylinder {
  public:
    /// The light, a cylinder of the table of lights, seen from `position`.
    SeenCylinder(const Emitter& light, Vec3 position);

    /// Whether the position lies farther from the axis than the cylinder's triangles do.
    [[nodiscard]] bool is_seen() const { return half_angle_ > 0.0; }
    /// A unit vector to the cylinder, which must be seen.
    [[nodiscard]] Vec3 sample(Point2 u) const;
    /// Density of sample() in a unit direction, per steradian.
    [[nodiscard]] double density(Vec3 direction) const;
    /// The first point in a direction of sample() that is as near to the axis as the cylinder's triangles
    /// are.
    [[nodiscard]] Vec3 entry(Vec3 direction) const;
    /// The unit vector from the axis to a point.
    [[nodiscard]] Vec3 outwards(Vec3 point) const;

  private:
    /// Distance across the axis to a coaxial cylinder, where the direction passes the axis at this angle.
    [[nodiscard]] double distance_across(double phi, double radius) const;

    Vec3 position_, end_;
    Vec3d axis_, across_, beside_;
    double radius_, outer_radius_;
    double low_, high_;  ///< the ends, measured along the axis from the position
    double distance_;    ///< to the axis
    double half_angle_ = 0.0;
};

}  // namespace nearlight::core
