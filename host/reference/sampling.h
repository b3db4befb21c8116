// SPDX-License-Identifier: Apache-2.0
// Sampling formulas of the reference path tracer, written independently of those in the kernels.
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

}  // namespace nearlight::core
