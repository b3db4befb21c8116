// SPDX-License-Identifier: Apache-2.0
#include "host/scene/seen_side.h"

#include <cmath>
#include <numbers>

#include "host/base/vec3d.h"

namespace nearlight::core {
namespace {

Vec3d from_eye(Vec3 eye, const Mat4& to_world, Vec3 position) {
    return as_double(transform_point(to_world, position)) - as_double(eye);
}

/// Six times the volume between the origin and a triangle; above 0 if its back is on the origin's side.
double spanned(Vec3d a, Vec3d b, Vec3d c) {
    return dot(a, cross(b, c));
}

/// The solid angle of a triangle as seen from the origin, with the sign of spanned() [Van Oosterom & Strackee
/// 1983].
double seen_angle(Vec3d a, Vec3d b, Vec3d c) {
    const double la = length(a);
    const double lb = length(b);
    const double lc = length(c);
    return 2.0 *
           std::atan2(spanned(a, b, c), la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
}

}  // namespace

bool shows_back(const Mesh& mesh, const Mat4& to_world, Vec3 eye) {
    double angle = 0;
    double volume = 0;
    double volume_of_parts = 0;
    for (const auto& [i, j, k] : mesh.triangles) {
        const Vec3d a = from_eye(eye, to_world, mesh.positions[i]);
        const Vec3d b = from_eye(eye, to_world, mesh.positions[j]);
        const Vec3d c = from_eye(eye, to_world, mesh.positions[k]);
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

}  // namespace nearlight::core
