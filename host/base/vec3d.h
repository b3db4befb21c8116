// SPDX-License-Identifier: Apache-2.0
// Vectors and colours in double precision.
#pragma once

#include <algorithm>
#include <cmath>

#include "host/base/math.h"

namespace nearlight::core {

struct Vec3d {
    double x = 0, y = 0, z = 0;
};

constexpr Vec3d as_double(Vec3 v) {
    return {v.x, v.y, v.z};
}
constexpr Vec3 as_float(Vec3d v) {
    return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

constexpr Vec3d operator+(Vec3d a, Vec3d b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
constexpr Vec3d operator-(Vec3d a, Vec3d b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
constexpr Vec3d operator-(Vec3d a) {
    return {-a.x, -a.y, -a.z};
}
constexpr Vec3d operator*(Vec3d a, Vec3d b) {
    return {a.x * b.x, a.y * b.y, a.z * b.z};
}
constexpr Vec3d operator*(Vec3d a, double s) {
    return {a.x * s, a.y * s, a.z * s};
}
constexpr Vec3d operator*(double s, Vec3d a) {
    return a * s;
}
constexpr Vec3d operator/(Vec3d a, double s) {
    return {a.x / s, a.y / s, a.z / s};
}
constexpr Vec3d& operator+=(Vec3d& a, Vec3d b) {
    return a = a + b;
}
constexpr Vec3d& operator*=(Vec3d& a, Vec3d b) {
    return a = a * b;
}
constexpr Vec3d& operator*=(Vec3d& a, double s) {
    return a = a * s;
}

constexpr double dot(Vec3d a, Vec3d b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
constexpr Vec3d cross(Vec3d a, Vec3d b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double length(Vec3d a) {
    return std::sqrt(dot(a, a));
}
/// The unit vector in the direction of `a`; a zero vector stays zero.
inline Vec3d normalize(Vec3d a) {
    const double l = length(a);
    return l > 0 ? a / l : a;
}
constexpr bool is_zero(Vec3d a) {
    return a.x == 0 && a.y == 0 && a.z == 0;
}
inline bool is_finite(Vec3d a) {
    return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z);
}
constexpr double max_component(Vec3d a) {
    return std::max(a.x, std::max(a.y, a.z));
}
/// The vector a·(1 − t) + b·t.
constexpr Vec3d mix(Vec3d a, Vec3d b, double t) {
    return a * (1 - t) + b * t;
}

}  // namespace nearlight::core
