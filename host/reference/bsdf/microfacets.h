// SPDX-License-Identifier: Apache-2.0
// Distributions of microfacet normals, and Smith's masking of them.
#pragma once

#include "host/base/vec3d.h"

namespace nearlight::core {

/// GGX or Beckmann microfacets with the roughness α along x and y [Walter et al., Microfacet Models for
/// Refraction through Rough Surfaces, EGSR 2007]. Directions and normals are in the local frame.
class Microfacets {
  public:
    Microfacets(bool beckmann, double alpha_x, double alpha_y);

    /// D(m), per steradian; its integral times cosθ over the hemisphere is 1.
    [[nodiscard]] double density(Vec3d m) const;
    /// Smith's G1 of the direction w (on either side), 0 where w and m disagree about the side. For
    /// Beckmann's distribution it is Walter's rational approximation, within 0.35 %, as renderers use it.
    [[nodiscard]] double masking(Vec3d w, Vec3d m) const;
    /// The masking and shadowing G1(a)·G1(b).
    [[nodiscard]] double masking(Vec3d a, Vec3d b, Vec3d m) const { return masking(a, m) * masking(b, m); }

    /// A normal that is visible from w (w.z > 0), with the density visible_density(), for u and v in [0, 1).
    /// [Heitz and d'Eon, Importance Sampling Microfacet-Based BSDFs using the Distribution of Visible
    /// Normals, EGSR 2014]
    [[nodiscard]] Vec3d sample_visible(Vec3d w, double u, double v) const;
    /// Density of sample_visible(), per steradian of m. It uses the exact masking.
    [[nodiscard]] double visible_density(Vec3d w, Vec3d m) const;

  private:
    /// 1 / (α·tanθ) of a direction, with the α of its azimuth; infinity for the normal.
    [[nodiscard]] double steepness(Vec3d w) const;
    [[nodiscard]] double exact_masking(Vec3d w) const;

    bool beckmann_;
    double alpha_x_, alpha_y_;
};

}  // namespace nearlight::core
