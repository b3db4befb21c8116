// SPDX-License-Identifier: Apache-2.0
#include "host/scene/gltf/seen_side.h"

#include <array>
#include <cmath>
#include <numbers>

namespace nearlight::core::gltf {
namespace {

using Vector = std::array<double, 3>;

Vector from_eye(Vec3 eye, const Mat4& to_world, Vec3 position) {
    const Vec3 p = transform_point(to_world, position);
    return {static_cast<double>(p.x) - static_cast<double>(eye.x),
            static_cast<double>(p.y) - static_cast<double>(eye.y),
            static_cast<double>(p.z) - static_cast<double>(eye.z)};
}

double product(const Vector& a, const Vector& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// Six times the volume between the origin and a triangle; above 0 if its back is on the origin's side.
double spanned(const Vector& a, const Vector& b, const Vector& c) {
    return a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
           a[2] * (b[0] * c[1] - b[1] * c[0]);
}

/// The solid angle of a triangle as seen from the origin, with the sign of spanned() [Van Oosterom & Strackee
/// 1983].
double seen_angle(const Vector& a, const Vector& b, const Vector& c) {
    const double la = std::sqrt(product(a, a));
    const double lb = std::sqrt(product(b, b));
    const double lc = std::sqrt(product(c, c));
    return 2.0 * std::atan2(spanned(a, b, c),
                            la * lb * lc + product(a, b) * lc + product(b, c) * la + product(c, a) * lb);
}

}  // namespace

bool shows_back(const Mesh& mesh, const Mat4& to_world, Vec3 eye) {
    double angle = 0;
    double volume = 0;
    double volume_of_parts = 0;
    for (const auto& [i, j, k] : mesh.triangles) {
        const Vector a = from_eye(eye, to_world, mesh.positions[i]);
        const Vector b = from_eye(eye, to_world, mesh.positions[j]);
        const Vector c = from_eye(eye, to_world, mesh.positions[k]);
        angle += seen_angle(a, b, c);
        volume += spanned(a, b, c);
        volume_of_parts += std::abs(spanned(a, b, c));
    }
    // A placement that mirrors keeps the front in front, but turns the order of the corners round.
    const double sign = linear_determinant(to_world) < 0 ? -1.0 : 1.0;
    const double turns =
        sign * angle / (4.0 * std::numbers::pi);  // how often the surface surrounds the point
    const bool faces_inwards = sign * volume < -1e-6 * volume_of_parts;  // more than rounding
    return turns > 0.5 || (turns > -0.5 && faces_inwards);
}

}  // namespace nearlight::core::gltf
