// SPDX-License-Identifier: Apache-2.0
#include "host/scene/camera.h"

#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include "nearlight/error.h"

namespace nearlight::core {
namespace {

void check_camera(const SceneCamera& camera, int width, int height) {
    if (width <= 0 || height <= 0) {
        throw Error(ErrorKind::invalid_argument,
                    "a picture of " + std::to_string(width) + "x" + std::to_string(height) +
                        " pixels is empty; its size must be at least 1x1",
                    "size");
    }
    if (!(camera.fov_x_degrees > 0.0 && camera.fov_x_degrees < 180.0)) {
        throw Error(ErrorKind::invalid_argument,
                    "a field of view of " + std::to_string(camera.fov_x_degrees) +
                        " degrees is not between 0 and 180; correct the scene's camera");
    }
}

void set_filter(const SceneCamera& from, Camera& to) {
    constexpr float kNoBorder = std::numeric_limits<float>::max();
    to.film_min_x = to.film_min_y = from.sample_border ? -kNoBorder : 0.0f;
    to.film_max_x = from.sample_border ? kNoBorder : static_cast<float>(to.width);
    to.film_max_y = from.sample_border ? kNoBorder : static_cast<float>(to.height);
    if (!is_pixel_box(from.filter)) {
        constexpr std::size_t kEntries = NEARLIGHT_FILTER_CELLS + 1;
        to.filter_radius = static_cast<float>(from.filter.radius);
        fill_filter_tables(from.filter, std::span(to.filter_absolute).first<kEntries>(),
                           std::span(to.filter_signed).first<kEntries>());
    }
}

std::array<double, 3> column(const Mat4& m, int index) {
    return {m(0, index), m(1, index), m(2, index)};
}

double norm(std::array<double, 3> v) {
    return std::hypot(v[0], v[1], v[2]);
}

std::array<double, 3> unit(const std::array<double, 3>& v) {
    const double length = norm(v);
    return {v[0] / length, v[1] / length, v[2] / length};
}

[[noreturn]] void refuse_pose(const std::string& reason) {
    throw Error(ErrorKind::invalid_argument, "the camera cannot be placed: " + reason, "camera");
}

void refuse_not_finite(std::array<double, 3> v, const char* what) {
    if (!std::isfinite(v[0]) || !std::isfinite(v[1]) || !std::isfinite(v[2])) {
        refuse_pose(std::string("its ") + what + " has a number that is not finite");
    }
}

std::array<double, 3> doubles(nearlight::Vec3 v) {
    return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}

}  // namespace

SceneCamera with_field_of_view(SceneCamera camera, double fov_x_degrees) {
    if (!(fov_x_degrees > 0.0 && fov_x_degrees < 180.0)) {
        refuse_pose("its field of view is " + std::to_string(fov_x_degrees) +
                    " degrees; it must be between 0 and 180");
    }
    for (int axis = 0; camera.kind == CameraKind::orthographic && axis < 3; ++axis) {
        const std::array<double, 3> direction = unit(column(camera.to_world, axis));
        for (int row = 0; row < 3; ++row) {
            camera.to_world(row, axis) = direction[static_cast<std::size_t>(row)];
        }
    }
    camera.kind = CameraKind::perspective;
    camera.fov_x_degrees = fov_x_degrees;
    return camera;
}

ExactPose exact_pose_of(const SceneCamera& camera) {
    const std::array<double, 3> origin = column(camera.to_world, 3);
    const std::array<double, 3> forward = unit(column(camera.to_world, 2));
    return {.origin = origin,
            .target = {origin[0] + forward[0], origin[1] + forward[1], origin[2] + forward[2]},
            .up = unit(column(camera.to_world, 1))};
}

CameraPose pose_of(const SceneCamera& camera) {
    const auto vector = [](const std::array<double, 3>& v) {
        return nearlight::Vec3{static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
    };
    const ExactPose exact = exact_pose_of(camera);
    CameraPose pose{.origin = vector(exact.origin), .target = vector(exact.target), .up = vector(exact.up)};
    if (camera.kind == CameraKind::perspective) {
        pose.fov_x_degrees = camera.fov_x_degrees;
    }
    return pose;
}

SceneCamera posed(SceneCamera camera, const CameraPose& pose) {
    if (pose.fov_x_degrees) {
        camera = with_field_of_view(camera, *pose.fov_x_degrees);
    }
    return posed(camera, {.origin = doubles(pose.origin),
                          .target = doubles(pose.target),
                          .up = pose.up ? doubles(*pose.up) : column(camera.to_world, 1)});
}

SceneCamera posed(SceneCamera camera, const ExactPose& pose) {
    refuse_not_finite(pose.origin, "origin");
    refuse_not_finite(pose.target, "target");
    refuse_not_finite(pose.up, "vector `up`");
    const Mat4 frame = look_at(pose.origin, pose.target, pose.up);
    if (!(norm(column(frame, 2)) > 0.5)) {
        refuse_pose("its target is its origin");
    }
    if (!(norm(column(frame, 0)) > 0.5)) {
        refuse_pose("its vector `up` is zero, or points where it looks; give another one");
    }
    const double side = linear_determinant(camera.to_world) < 0.0 ? -1.0 : 1.0;
    for (int axis = 0; axis < 3; ++axis) {
        const double length = norm(column(camera.to_world, axis));
        const double scale = axis == 0 ? side * length : length;
        for (int row = 0; row < 3; ++row) {
            camera.to_world(row, axis) = frame(row, axis) * scale;
        }
    }
    for (int row = 0; row < 3; ++row) {
        camera.to_world(row, 3) = frame(row, 3);
    }
    return camera;
}

PictureWindow picture_window(const SceneCamera& camera, int width, int height) {
    const double film_width = camera.kind == CameraKind::orthographic
                                  ? 2.0
                                  : 2.0 * std::tan(camera.fov_x_degrees * std::numbers::pi / 360.0);
    const double pixel = film_width * camera.film_part / width;
    return {.left = film_width * (camera.center_x - 0.5 * camera.film_part),
            .top = film_width * camera.center_y - 0.5 * pixel * height,
            .pixel = pixel};
}

Camera make_camera(const SceneCamera& camera, int width, int height) {
    check_camera(camera, width, height);
    const PictureWindow window = picture_window(camera, width, height);
    const bool is_orthographic = camera.kind == CameraKind::orthographic;
    const auto to_world = [&](double x, double y, double z) {
        return transform_vector(camera.to_world,
                                {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)});
    };
    Camera result{};
    result.origin = transform_point(camera.to_world, {0, 0, 0});
    result.width = static_cast<uint>(width);
    result.height = static_cast<uint>(height);
    result.corner = to_world(-window.left, -window.top, is_orthographic ? 0.0 : 1.0);
    result.step_x = to_world(-window.pixel, 0.0, 0.0);
    result.step_y = to_world(0.0, -window.pixel, 0.0);
    const Vec3 forward = to_world(0.0, 0.0, 1.0);
    result.forward = normalize(forward);
    result.is_orthographic = is_orthographic ? 1 : 0;
    result.hides_emitters = camera.hide_emitters ? 1 : 0;
    // An orthographic camera's transform may scale the near clip, but not the distance from it to the far
    // one, as in Mitsuba.
    const double near_clip =
        camera.near_clip * (is_orthographic ? static_cast<double>(length(forward)) : 1.0);
    result.near_clip = static_cast<float>(near_clip);
    result.far_clip = static_cast<float>(near_clip + (camera.far_clip - camera.near_clip));
    result.lens_x = to_world(camera.aperture_radius, 0.0, 0.0);
    result.lens_y = to_world(0.0, camera.aperture_radius, 0.0);
    result.focus_distance = static_cast<float>(camera.focus_distance);
    set_filter(camera, result);
    return result;
}

RayQuery pixel_ray(const Camera& camera, uint x, uint y) {
    const Vec3 d = camera.corner + (static_cast<float>(x) + 0.5f) * camera.step_x +
                   (static_cast<float>(y) + 0.5f) * camera.step_y;
    if (camera.is_orthographic != 0) {
        return {camera.origin + d, camera.near_clip, camera.forward, camera.far_clip};
    }
    const Vec3 direction = normalize(d);
    const float cosine = dot(direction, camera.forward);
    return {camera.origin, camera.near_clip / cosine, direction, camera.far_clip / cosine};
}

std::optional<FilmPosition> film_position(const SceneCamera& camera, Vec3 point) {
    const Vec3 local = transform_point(inverse(camera.to_world), point);
    if (!(local.z > 0.0f)) {
        return std::nullopt;
    }
    const PictureWindow window = picture_window(camera, camera.width, camera.height);
    const bool is_orthographic = camera.kind == CameraKind::orthographic;
    const double scale = is_orthographic ? 1.0 : static_cast<double>(local.z);
    const Vec3 start = is_orthographic ? Vec3{local.x, local.y, 0} : Vec3{0, 0, 0};
    return FilmPosition{(-static_cast<double>(local.x) / scale - window.left) / window.pixel,
                        (-static_cast<double>(local.y) / scale - window.top) / window.pixel,
                        static_cast<double>(length(point - transform_point(camera.to_world, start)))};
}

}  // namespace nearlight::core
