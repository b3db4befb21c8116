// SPDX-License-Identifier: Apache-2.0
#include "host/reference/spherical_triangle.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace nearlight::core {
namespace {

using Double3 = std::array<double, 3>;

double dot3(const Double3& a, const Double3& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

Double3 cross3(const Double3& a, const Double3& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

Double3 scaled_sum(double p, const Double3& a, double q, const Double3& b) {
    return {p * a[0] + q * b[0], p * a[1] + q * b[1], p * a[2] + q * b[2]};
}

/// The unit vector along `a`, or zero.
Double3 unit(const Double3& a) {
    const double l = std::sqrt(dot3(a, a));
    return l > 0.0 ? Double3{a[0] / l, a[1] / l, a[2] / l} : Double3{};
}

/// The unit part of x that is orthogonal to the unit vector y.
Double3 orthogonal_part(const Double3& x, const Double3& y) {
    return unit(scaled_sum(1.0, x, -dot3(x, y), y));
}

/// The angle at p between the arcs to q and to r.
double corner_angle(const Double3& p, const Double3& q, const Double3& r) {
    const Double3 to_q = orthogonal_part(q, p);
    const Double3 to_r = orthogonal_part(r, p);
    const Double3 normal = cross3(to_q, to_r);
    return std::atan2(std::sqrt(dot3(normal, normal)), dot3(to_q, to_r));
}

}  // namespace

SphericalTriangle::SphericalTriangle(const std::array<Vec3, 3>& corners, Vec3 center) {
    const auto direction = [&](Vec3 corner) {
        return unit({double(corner.x) - center.x, double(corner.y) - center.y, double(corner.z) - center.z});
    };
    a_ = direction(corners[0]);
    b_ = direction(corners[1]);
    c_ = direction(corners[2]);
    alpha_ = corner_angle(a_, b_, c_);
    cos_side_c_ = dot3(a_, b_);
    const double excess = alpha_ + corner_angle(b_, c_, a_) + corner_angle(c_, a_, b_) - std::numbers::pi;
    solid_angle_ = excess > 1e-9 && std::abs(dot3(a_, cross3(b_, c_))) > 0.0 ? excess : 0.0;
}

Vec3 SphericalTriangle::sample(Point2 random) const {
    const double area = random.x * solid_angle_;
    const double s = std::sin(area - alpha_);
    const double t = std::cos(area - alpha_);
    const double u = t - std::cos(alpha_);
    const double v = s + std::sin(alpha_) * cos_side_c_;
    const double denominator = (v * s + u * t) * std::sin(alpha_);
    const double q = denominator != 0.0 ? ((v * t - u * s) * std::cos(alpha_) - v) / denominator : 1.0;
    const double cos_q = std::clamp(q, -1.0, 1.0);
    const Double3 on_arc =
        unit(scaled_sum(cos_q, a_, std::sqrt(std::max(0.0, 1.0 - cos_q * cos_q)), orthogonal_part(c_, a_)));
    const double z = 1.0 - random.y * (1.0 - dot3(on_arc, b_));
    const Double3 found =
        unit(scaled_sum(z, b_, std::sqrt(std::max(0.0, 1.0 - z * z)), orthogonal_part(on_arc, b_)));
    return {static_cast<float>(found[0]), static_cast<float>(found[1]), static_cast<float>(found[2])};
}

}  // namespace nearlight::core
