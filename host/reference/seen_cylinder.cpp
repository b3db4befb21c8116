// SPDX-License-Identifier: Apache-2.0
#include "host/reference/seen_cylinder.h"

#include <algorithm>
#include <cmath>

namespace nearlight::core {

SeenCylinder::SeenCylinder(const Emitter& light, Vec3 position)
    : position_(position),
      end_(light.position),
      axis_(normalize(as_double(light.direction))),
      radius_(light.radius),
      outer_radius_(light.outer_radius) {
    const Vec3d to_end = as_double(light.position) - as_double(position);
    low_ = dot(to_end, axis_);
    high_ = low_ + static_cast<double>(light.length);
    const Vec3d to_axis = to_end - axis_ * low_;
    distance_ = length(to_axis);
    if (distance_ > outer_radius_) {
        across_ = to_axis * (1 / distance_);
        beside_ = cross(axis_, across_);
        half_angle_ = std::asin(std::min(1.0, radius_ / distance_));
    }
}

double SeenCylinder::distance_across(double phi, double radius) const {
    const double past = distance_ * std::sin(phi);
    return distance_ * std::cos(phi) - std::sqrt(std::max(0.0, radius * radius - past * past));
}

Vec3 SeenCylinder::sample(Point2 u) const {
    const double phi = (2 * static_cast<double>(u.x) - 1) * half_angle_;
    const double across = distance_across(phi, radius_);
    const double first = std::atan2(low_, across);
    const double last = std::atan2(high_, across);
    const double elevation = first + static_cast<double>(u.y) * (last - first);
    return normalize(as_float((across_ * std::cos(phi) + beside_ * std::sin(phi)) * std::cos(elevation) +
                              axis_ * std::sin(elevation)));
}

double SeenCylinder::density(Vec3 direction) const {
    const Vec3d d = as_double(direction);
    const double phi = std::atan2(dot(d, beside_), dot(d, across_));
    if (!is_seen() || std::abs(phi) >= half_angle_) {
        return 0.0;
    }
    const double across = distance_across(phi, radius_);
    const double first = std::atan2(low_, across);
    const double last = std::atan2(high_, across);
    const double elevation = std::asin(std::clamp(dot(d, axis_), -1.0, 1.0));
    const bool meets = elevation > first && elevation < last;
    return meets ? 1 / (2 * half_angle_ * (last - first) * std::cos(elevation)) : 0.0;
}

Vec3 SeenCylinder::entry(Vec3 direction) const {
    const Vec3d d = as_double(direction);
    const double phi = std::atan2(dot(d, beside_), dot(d, across_));
    const double flat = std::hypot(dot(d, beside_), dot(d, across_));
    const double way = distance_across(phi, outer_radius_) / std::max(flat, 1e-9);
    return position_ + direction * static_cast<float>(way);
}

Vec3 SeenCylinder::outwards(Vec3 point) const {
    const Vec3d from_end = as_double(point) - as_double(end_);
    return as_float(normalize(from_end - axis_ * dot(from_end, axis_)));
}

}  // namespace nearlight::core
