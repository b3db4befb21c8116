// SPDX-License-Identifier: Apache-2.0
// Small vector algebra of the host. Vec3 itself is shared with the kernels.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "kernels/shared/types.h"

namespace nearlight::core {

inline constexpr float kPi = std::numbers::pi_v<float>;
inline constexpr float kInfinity = std::numeric_limits<float>::infinity();

constexpr Vec3 operator+(Vec3 a, Vec3 b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
constexpr Vec3 operator-(Vec3 a, Vec3 b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
constexpr Vec3 operator-(Vec3 a) {
    return {-a.x, -a.y, -a.z};
}
constexpr Vec3 operator*(Vec3 a, Vec3 b) {
    return {a.x * b.x, a.y * b.y, a.z * b.z};
}
constexpr Vec3 operator*(Vec3 a, float s) {
    return {a.x * s, a.y * s, a.z * s};
}
constexpr Vec3 operator*(float s, Vec3 a) {
    return a * s;
}
constexpr Vec3 operator/(Vec3 a, float s) {
    return {a.x / s, a.y / s, a.z / s};
}
constexpr Vec3& operator+=(Vec3& a, Vec3 b) {
    return a = a + b;
}
constexpr Vec3& operator*=(Vec3& a, float s) {
    return a = a * s;
}
constexpr Vec3& operator*=(Vec3& a, Vec3 b) {
    return a = a * b;
}
constexpr bool operator==(Vec3 a, Vec3 b) {
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

constexpr float dot(Vec3 a, Vec3 b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
constexpr Vec3 cross(Vec3 a, Vec3 b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline float length(Vec3 a) {
    return std::sqrt(dot(a, a));
}
/// The unit vector in the direction of `a`; a zero vector stays zero.
inline Vec3 normalize(Vec3 a) {
    const float l = length(a);
    return l > 0.0f ? a / l : a;
}
inline bool is_finite(Vec3 a) {
    return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z);
}
constexpr bool is_zero(Vec3 a) {
    return a.x == 0.0f && a.y == 0.0f && a.z == 0.0f;
}
constexpr Vec3 min(Vec3 a, Vec3 b) {
    return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)};
}
constexpr Vec3 max(Vec3 a, Vec3 b) {
    return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)};
}
constexpr float max_component(Vec3 a) {
    return std::max(a.x, std::max(a.y, a.z));
}
/// Relative luminance of linear sRGB.
constexpr float luminance(Vec3 c) {
    return 0.2126f * c.x + 0.7152f * c.y + 0.0722f * c.z;
}
constexpr float degrees_to_radians(float degrees) {
    return degrees * (kPi / 180.0f);
}

/// Two unit vectors that form a right-handed orthonormal frame (tangent, bitangent, n) with the unit n.
/// [Duff et al., Building an Orthonormal Basis, Revisited, JCGT 2017]
inline std::array<Vec3, 2> orthonormal_basis(Vec3 n) {
    const float sign = std::copysign(1.0f, n.z);
    const float a = -1.0f / (sign + n.z);
    const float b = n.x * n.y * a;
    return {Vec3{1.0f + sign * n.x * n.x * a, sign * b, -sign * n.x}, Vec3{b, sign + n.y * n.y * a, -n.y}};
}

/// An axis-aligned box, which is empty until something is put in.
struct Aabb {
    Vec3 min{std::numeric_limits<float>::infinity(), std::numeric_limits<float>::infinity(),
             std::numeric_limits<float>::infinity()};
    Vec3 max{-std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity(),
             -std::numeric_limits<float>::infinity()};

    void extend(Vec3 p) {
        min = nearlight::core::min(min, p);
        max = nearlight::core::max(max, p);
    }
    void extend(const Aabb& b) {
        min = nearlight::core::min(min, b.min);
        max = nearlight::core::max(max, b.max);
    }
    [[nodiscard]] bool is_empty() const { return !(min.x <= max.x && min.y <= max.y && min.z <= max.z); }
    [[nodiscard]] Vec3 size() const { return is_empty() ? Vec3{0, 0, 0} : max - min; }
    [[nodiscard]] Vec3 center() const { return is_empty() ? Vec3{0, 0, 0} : (min + max) * 0.5f; }
    /// Half the surface area, which is all that the surface area heuristic needs.
    [[nodiscard]] float half_area() const {
        const Vec3 s = size();
        return s.x * s.y + s.y * s.z + s.z * s.x;
    }
};

/// Row-major 4×4 matrix in double precision; points are columns: p' = M·p.
struct Mat4 {
    std::array<double, 16> m{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

    [[nodiscard]] double operator()(int row, int column) const {
        return m[static_cast<size_t>(row * 4 + column)];
    }
    [[nodiscard]] double& operator()(int row, int column) { return m[static_cast<size_t>(row * 4 + column)]; }
};
Mat4 operator*(const Mat4& a, const Mat4& b);
/// The inverse matrix. Throws std::domain_error if there is none.
Mat4 inverse(const Mat4& a);
/// Determinant of the upper left 3×3 part: negative where the transform mirrors.
double linear_determinant(const Mat4& a);
Vec3 transform_point(const Mat4& a, Vec3 p);
Vec3 transform_vector(const Mat4& a, Vec3 v);
/// Transforms a normal by the transpose of `inverse`, the inverse of a transform. The result is not
/// normalised.
Vec3 transform_normal_by_inverse(const Mat4& inverse, Vec3 n);
Mat4 translation(double x, double y, double z);
Mat4 scaling(double x, double y, double z);
/// Rodrigues' formula with the axis as it is: a rotation if its length is 1, otherwise also a stretch.
Mat4 rodrigues(double x, double y, double z, double degrees);
/// Rotation about an axis of any length, counter-clockwise when the axis points at the viewer.
Mat4 rotation(double axis_x, double axis_y, double axis_z, double degrees);
/// The transform from camera to world, with +Z towards the target, +Y up and +X to the left, as in Mitsuba.
/// It has no inverse if `target` is `origin` or `up` points along the view.
Mat4 look_at(std::array<double, 3> origin, std::array<double, 3> target, std::array<double, 3> up);

}  // namespace nearlight::core
