// SPDX-License-Identifier: Apache-2.0
#include "host/reference/seen_sphere.h"

#include <algorithm>
#include <cmath>

namespace nearlight::core {
namespace {

double squared_distance(Vec3 v) {
    const double x = v.x;
    const double y = v.y;
    const double z = v.z;
    return x * x + y * y + z * z;
}

}  // namespace

SeenSphere::SeenSphere(const Emitter& light, Vec3 position)
    : position_(position),
      to_center_(light.position - position),
      radius_(light.radius),
      outer_radius_(light.outer_radius),
      distance_(std::sqrt(squared_distance(to_center_))) {
    if (distance_ > outer_radius_) {
        sine_ = radius_ / distance_;
        cosine_ = std::sqrt(1.0 - sine_ * sine_);
    }
}

double SeenSphere::solid_angle() const {
    return 2.0 * std::numbers::pi * sine_ * sine_ / (1.0 + cosine_);  // 2π · (1 − cosine)
}

Vec3 SeenSphere::sample(Point2 u) const {
    const double below_one = static_cast<double>(u.x) * sine_ * sine_ / (1.0 + cosine_);
    const double sine = std::sqrt(below_one * (2.0 - below_one));
    const double angle = 2.0 * std::numbers::pi * static_cast<double>(u.y);
    const Vec3 local{static_cast<float>(sine * std::cos(angle)), static_cast<float>(sine * std::sin(angle)),
                     static_cast<float>(1.0 - below_one)};
    return normalize(Frame(normalize(to_center_)).to_world(local));
}

double SeenSphere::density(Vec3 direction) const {
    const Vec3 past = to_center_ - direction * dot(to_center_, direction);
    const bool meets = squared_distance(past) < radius_ * radius_;
    return meets && sine_ > 0.0 ? 1.0 / solid_angle() : 0.0;
}

Vec3 SeenSphere::entry(Vec3 direction) const {
    const double along = dot(to_center_, direction);
    const Vec3 past = to_center_ - direction * static_cast<float>(along);
    const double within = std::sqrt(std::max(0.0, outer_radius_ * outer_radius_ - squared_distance(past)));
    return position_ + direction * static_cast<float>(along - within);
}

}  // namespace nearlight::core
