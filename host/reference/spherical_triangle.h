// SPDX-License-Identifier: Apache-2.0
// Directions to a triangle, uniform over the solid angle under which it is seen. The formulas are those of
// Arvo, Stratified Sampling of Spherical Triangles, 1995, in double precision, and share nothing with the
// kernels.
#pragma once

#include <array>

#include "host/reference/sampling.h"

namespace nearlight::core {

class SphericalTriangle {
  public:
    /// The triangle with these corners, seen from `center`.
    SphericalTriangle(const std::array<Vec3, 3>& corners, Vec3 center);

    /// Steradians; 0 for a triangle that is seen from its edge, or that contains the centre.
    [[nodiscard]] double solid_angle() const { return solid_angle_; }
    /// A unit vector from the centre, uniform over the solid angle, which must be greater than 0.
    [[nodiscard]] Vec3 sample(Point2 u) const;

  private:
    using Double3 = std::array<double, 3>;
    Double3 a_{}, b_{}, c_{};  ///< unit vectors to the corners
    double alpha_ = 0.0;       ///< angle at a
    double cos_side_c_ = 1.0;  ///< cosine of the side from a to b
    double solid_angle_ = 0.0;
};

}  // namespace nearlight::core
