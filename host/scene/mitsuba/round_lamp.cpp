// SPDX-License-Identifier: Apache-2.0
#include "host/scene/mitsuba/round_lamp.h"

#include <cmath>
#include <span>

namespace nearlight::core::mitsuba {
namespace {

constexpr double kRoundness = 1e-5;

double dot_of_columns(const Mat4& m, int i, int j) {
    return m(0, i) * m(0, j) + m(1, i) * m(1, j) + m(2, i) * m(2, j);
}

// The radius of the circle that the transform makes of the unit circle in the plane XY, at a right angle to
// what it makes of the Z axis; 0 if it does not.
double round_radius(const Mat4& m) {
    const double x = dot_of_columns(m, 0, 0);
    const double y = dot_of_columns(m, 1, 1);
    const double z = dot_of_columns(m, 2, 2);
    const bool is_round =
        std::abs(x - y) <= kRoundness * x && std::abs(dot_of_columns(m, 0, 1)) <= kRoundness * x;
    const bool is_right = std::abs(dot_of_columns(m, 0, 2)) <= kRoundness * std::sqrt(x * z) &&
                          std::abs(dot_of_columns(m, 1, 2)) <= kRoundness * std::sqrt(x * z);
    return is_round && is_right && x > 0.0 && z > 0.0 && std::isfinite(x * z) ? std::sqrt(x) : 0.0;
}

}  // namespace

bool is_round_sphere(const Mat4& to_world) {
    const double radius = round_radius(to_world);
    return radius > 0.0 &&
           std::abs(std::sqrt(dot_of_columns(to_world, 2, 2)) - radius) <= kRoundness * radius;
}

Mat4 rounded_sphere(const Mat4& to_world) {
    const double radius = std::sqrt(dot_of_columns(to_world, 0, 0));
    Mat4 round = to_world;
    for (int column = 1; column < 3; ++column) {
        for (int before = 0; before < column; ++before) {
            const double part = dot_of_columns(round, column, before) / (radius * radius);
            for (int row = 0; row < 3; ++row) {
                round(row, column) -= part * round(row, before);
            }
        }
        const double scale = radius / std::sqrt(dot_of_columns(round, column, column));
        for (int row = 0; row < 3; ++row) {
            round(row, column) *= scale;
        }
    }
    return round;
}

std::optional<RoundLamp> round_lamp(const Scene& scene, const std::string& type, const Mat4& to_world,
                                    std::size_t first_triangle) {
    const double radius = round_radius(to_world);
    const bool is_sphere = type == "sphere" && is_round_sphere(to_world);
    if (!(radius > 0.0) || (!is_sphere && type != "cylinder")) {
        return std::nullopt;
    }
    RoundLamp lamp;
    lamp.center = transform_point(to_world, {0, 0, 0});
    lamp.axis = is_sphere ? Vec3{0, 0, 0} : transform_vector(to_world, {0, 0, 1});
    lamp.radius = lamp.outer_radius = static_cast<float>(radius);
    lamp.first_triangle = static_cast<uint>(first_triangle);
    lamp.triangle_count = static_cast<uint>(scene.triangles.size() - first_triangle);
    const Vec3 along = normalize(lamp.axis);
    for (const Triangle& triangle : std::span(scene.triangles).subspan(first_triangle)) {
        for (const uint vertex : {triangle.v0, triangle.v1, triangle.v2}) {
            const Vec3 from_center = scene.vertices[vertex].position - lamp.center;
            const float distance = length(from_center - along * dot(from_center, along));
            lamp.outer_radius = std::max(lamp.outer_radius, distance);
        }
    }
    return lamp;
}

}  // namespace nearlight::core::mitsuba
