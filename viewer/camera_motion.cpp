// SPDX-License-Identifier: Apache-2.0
#include "viewer/camera_motion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "viewer/vectors.h"

namespace nearlight::viewer {
namespace {

constexpr float kHalfPi = std::numbers::pi_v<float> / 2;
/// The view stays this far from straight up and straight down, in radians.
constexpr float kPoleMargin = 0.02f;
constexpr float kMinPivotDistance = 1e-4f;

bool same(Vec3 a, Vec3 b) {
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

Vec3 nearest_axis(Vec3 direction) {
    const std::array<float, 3> sizes{std::abs(direction.x), std::abs(direction.y), std::abs(direction.z)};
    const auto largest = std::max_element(sizes.begin(), sizes.end()) - sizes.begin();
    if (largest == 0) {
        return {std::copysign(1.0f, direction.x), 0, 0};
    }
    return largest == 1 ? Vec3{0, std::copysign(1.0f, direction.y), 0}
                        : Vec3{0, 0, std::copysign(1.0f, direction.z)};
}

float largest_side(const Box& bounds) {
    const Vec3 size = bounds.max - bounds.min;
    const float side = std::max({size.x, size.y, size.z});
    return side > 0.0f && std::isfinite(side) ? side : 1.0f;
}

/// The vector v turned about the unit axis, counter-clockwise where the axis points at the viewer.
Vec3 turned(Vec3 v, Vec3 axis, float angle) {
    return v * std::cos(angle) + cross(axis, v) * std::sin(angle) +
           axis * (dot(axis, v) * (1.0f - std::cos(angle)));
}

/// The direction of the view after turns to the right and upwards, away from the poles.
Vec3 turned_view(const FreeCamera& camera, float right, float upwards) {
    const float height = std::asin(std::clamp(dot(camera.forward, camera.up), -1.0f, 1.0f));
    const float limit = kHalfPi - kPoleMargin;
    const float rise =
        std::clamp(height + upwards, std::min(-limit, height), std::max(limit, height)) - height;
    return normalize(turned(turned(camera.forward, right_of(camera), rise), camera.up, -right));
}

Vec3 pivot_of(const FreeCamera& camera) {
    return camera.origin + camera.forward * camera.pivot_distance;
}

}  // namespace

bool shows_same(const FreeCamera& a, const FreeCamera& b) {
    return same(a.origin, b.origin) && same(a.forward, b.forward) && same(a.up, b.up) &&
           a.fov_degrees == b.fov_degrees;
}

FreeCamera free_camera(const CameraPose& pose, const Box& bounds) {
    FreeCamera camera;
    camera.origin = pose.origin;
    camera.forward = normalize(pose.target - pose.origin);
    camera.up = nearest_axis(pose.up.value_or(Vec3{0, 1, 0}));
    camera.fov_degrees = pose.fov_x_degrees.value_or(0.0);
    const Vec3 middle = (bounds.min + bounds.max) * 0.5f;
    const float ahead = dot(middle - camera.origin, camera.forward);
    const bool is_known = std::isfinite(ahead) && ahead > 0.0f;
    camera.pivot_distance = std::max(is_known ? ahead : 0.25f * largest_side(bounds), kMinPivotDistance);
    return camera;
}

CameraPose pose_of(const FreeCamera& camera) {
    CameraPose pose{.origin = camera.origin, .target = pivot_of(camera), .up = camera.up};
    if (camera.fov_degrees > 0.0) {
        pose.fov_x_degrees = camera.fov_degrees;
    }
    return pose;
}

Vec3 right_of(const FreeCamera& camera) {
    return normalize(cross(camera.forward, camera.up));
}

FreeCamera look_about(const FreeCamera& camera, float right, float upwards) {
    FreeCamera result = camera;
    result.forward = turned_view(camera, right, upwards);
    return result;
}

FreeCamera orbit(const FreeCamera& camera, float right, float upwards) {
    FreeCamera result = camera;
    result.forward = turned_view(camera, -right, -upwards);
    result.origin = pivot_of(camera) - result.forward * camera.pivot_distance;
    return result;
}

FreeCamera walk(const FreeCamera& camera, float right, float upwards, float ahead) {
    FreeCamera result = camera;
    result.origin = camera.origin + right_of(camera) * right + camera.up * upwards + camera.forward * ahead;
    return result;
}

FreeCamera pan(const FreeCamera& camera, float right, float upwards) {
    constexpr double kDegree = std::numbers::pi / 180.0;
    const double width = camera.fov_degrees > 0.0 ? 2.0 * std::tan(0.5 * camera.fov_degrees * kDegree) : 1.0;
    const float scale = static_cast<float>(width) * camera.pivot_distance;
    FreeCamera result = camera;
    const Vec3 picture_up = cross(right_of(camera), camera.forward);
    result.origin = camera.origin + right_of(camera) * (right * scale) + picture_up * (upwards * scale);
    return result;
}

FreeCamera approach(const FreeCamera& camera, float factor) {
    FreeCamera result = camera;
    result.pivot_distance = std::max(camera.pivot_distance / std::max(factor, 1e-3f), kMinPivotDistance);
    result.origin = pivot_of(camera) - camera.forward * result.pivot_distance;
    return result;
}

FreeCamera with_pivot(const FreeCamera& camera, float distance) {
    FreeCamera result = camera;
    result.pivot_distance = std::max(distance, kMinPivotDistance);
    return result;
}

float walking_speed(const Box& bounds) {
    return largest_side(bounds) / 8.0f;
}

}  // namespace nearlight::viewer
