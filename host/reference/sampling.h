// SPDX-License-Identifier: Apache-2.0
// Sampling and reflection formulas of the reference path tracer, written independently of those in the
// kernels.
#pragma once

#include "host/base/math.h"

namespace nearlight::core {

struct Point2 {
    float x = 0.0f;
    float y = 0.0f;
};

/// Orthonormal frame with the unit vector n as its z axis.
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
/// Barycentric weights of v1 and v2, uniform over a triangle for u in [0, 1)².
Point2 sample_triangle(Point2 u);

/// Unpolarised reflectance of a dielectric interface for cos_i ≥ 0; 1 beyond the critical angle. eta is the
/// refractive index behind the interface divided by that in front of it.
float fresnel_dielectric(float cos_i, float eta);
/// Unpolarised reflectance of a metal with the complex refractive index eta + i·k in air, per colour channel,
/// for cos_i ≥ 0.
Vec3 fresnel_conductor(float cos_i, Vec3 eta, Vec3 k);

/// The unit vector w mirrored about the unit vector m; both point away from the surface.
Vec3 reflect(Vec3 w, Vec3 m);
/// Refracts w (away from the surface, dot(w, m) > 0) through an interface with normal m; eta as for
/// fresnel_dielectric(). The zero vector on total internal reflection.
Vec3 refract(Vec3 w, Vec3 m, float eta);

/// Samples a microfacet normal of a GGX surface seen from the local direction w (w.z > 0), with density
/// proportional to its visible area [Heitz, Sampling the GGX Distribution of Visible Normals, JCGT 2018].
Vec3 sample_ggx_visible_normal(Vec3 w, float alpha, Point2 u);
/// Smith's masking function G1 of the local direction w. When visible normals are sampled, it is the weight
/// of the other direction.
float ggx_masking(Vec3 w, float alpha);

}  // namespace nearlight::core
