// SPDX-License-Identifier: Apache-2.0
// Sampling and reflection formulas of the reference path tracer, written independently of the kernels'.
#pragma once

#include "host/base/math.h"

namespace nearlight::core {

struct Point2 {
    float x = 0.0f;
    float y = 0.0f;
};

/// Frame with the unit vector n as its z axis.
class Frame {
  public:
    explicit Frame(Vec3 n) : n_(n) {
        const auto [tangent, bitangent] = orthonormal_basis(n);
        tangent_ = tangent;
        bitangent_ = bitangent;
    }
    [[nodiscard]] Vec3 to_world(Vec3 v) const { return tangent_ * v.x + bitangent_ * v.y + n_ * v.z; }
    [[nodiscard]] Vec3 to_local(Vec3 v) const { return {dot(v, tangent_), dot(v, bitangent_), dot(v, n_)}; }

  private:
    Vec3 n_, tangent_, bitangent_;
};

/// Unit vector about +Z with density cosθ/π, for u in [0, 1)².
Vec3 sample_cosine_hemisphere(Point2 u);
/// Barycentric weights (of v1 and v2), uniform over a triangle.
Point2 sample_triangle(Point2 u);

/// Unpolarised reflectance of an interface, cos_i ≥ 0, eta = index behind ÷ index before it; 1 beyond the
/// critical angle.
float fresnel_dielectric(float cos_i, float eta);
/// Of a metal with complex index eta + i·k in air, per colour channel.
Vec3 fresnel_conductor(float cos_i, Vec3 eta, Vec3 k);

/// Unit w mirrored about the unit vector m, both pointing away from the surface.
Vec3 reflect(Vec3 w, Vec3 m);
/// Refracts w (away from the surface, dot(w, m) > 0) through an interface with normal m; eta as above.
/// The zero vector on total internal reflection.
Vec3 refract(Vec3 w, Vec3 m, float eta);

/// Microfacet normal of a GGX surface as seen from the local direction w (w.z > 0), in proportion to its
/// visible area [Heitz, Sampling the GGX Distribution of Visible Normals, JCGT 2018].
Vec3 sample_ggx_visible_normal(Vec3 w, float alpha, Point2 u);
/// Smith's masking of direction w (local): with visible normals, the weight of the other direction.
float ggx_masking(Vec3 w, float alpha);

}  // namespace nearlight::core
