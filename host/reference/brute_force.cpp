// SPDX-License-Identifier: Apache-2.0
#include "host/reference/brute_force.h"

#include <array>
#include <optional>

namespace nearlight::core {
namespace {

using DoubleVector = std::array<double, 3>;

DoubleVector to_double(Vec3 v) {
    return {v.x, v.y, v.z};
}
DoubleVector operator-(const DoubleVector& a, const DoubleVector& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
double dot(const DoubleVector& a, const DoubleVector& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
DoubleVector cross(const DoubleVector& a, const DoubleVector& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

struct Crossing {
    double t, u, v;
};

// Comparisons are written so that a NaN fails them and the ray misses.
std::optional<Crossing> cross_triangle(const Scene& scene, const Triangle& triangle,
                                       const DoubleVector& origin, const DoubleVector& direction) {
    const DoubleVector v0 = to_double(scene.vertices[triangle.v0].position);
    const DoubleVector edge1 = to_double(scene.vertices[triangle.v1].position) - v0;
    const DoubleVector edge2 = to_double(scene.vertices[triangle.v2].position) - v0;
    const DoubleVector p = cross(direction, edge2);
    const double determinant = dot(edge1, p);
    if (!(determinant < 0.0 || determinant > 0.0)) {
        return std::nullopt;
    }
    const DoubleVector s = origin - v0;
    const DoubleVector q = cross(s, edge1);
    const double u = dot(s, p) / determinant;
    const double v = dot(direction, q) / determinant;
    if (!(u >= 0.0 && v >= 0.0 && u + v <= 1.0)) {
        return std::nullopt;
    }
    return Crossing{dot(edge2, q) / determinant, u, v};
}

}  // namespace

BvhHit brute_force_closest_hit(const Scene& scene, std::span<const uint> ids, Vec3 origin, Vec3 direction,
                               float t_min, float t_max) {
    const DoubleVector o = to_double(origin);
    const DoubleVector d = to_double(direction);
    BvhHit hit;
    double closest = t_max;
    const std::size_t count = ids.empty() ? scene.triangles.size() : ids.size();
    for (std::size_t i = 0; i < count; ++i) {
        const uint id = ids.empty() ? static_cast<uint>(i) : ids[i];
        const auto crossing = cross_triangle(scene, scene.triangles[id], o, d);
        if (crossing && crossing->t > t_min && crossing->t < closest) {
            closest = crossing->t;
            hit = {static_cast<float>(crossing->t), static_cast<float>(crossing->u),
                   static_cast<float>(crossing->v), id};
        }
    }
    return hit;
}

bool brute_force_occluded(const Scene& scene, std::span<const uint> ids, Vec3 origin, Vec3 direction,
                          float t_min, float t_max) {
    return brute_force_closest_hit(scene, ids, origin, direction, t_min, t_max).triangle != ~0u;
}

}  // namespace nearlight::core
