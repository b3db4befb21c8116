// SPDX-License-Identifier: Apache-2.0
#include "host/cli/camera_options.h"

#include <charconv>
#include <cmath>

#include "host/scene/camera.h"
#include "nearlight/error.h"

namespace nearlight::core {
namespace {

/// Reads "X,Y,Z".
nearlight::Vec3 point_of(const std::string& option, const std::string& text) {
    float numbers[3] = {};
    const char* place = text.data();
    const char* const end = place + text.size();
    for (int i = 0; i < 3; ++i) {
        if (i > 0 && (place == end || *place++ != ',')) {
            place = nullptr;
            break;
        }
        const auto [next, error] = std::from_chars(place, end, numbers[i]);
        if (error != std::errc() || !std::isfinite(numbers[i])) {
            place = nullptr;
            break;
        }
        place = next;
    }
    if (place != end) {
        throw Error(ErrorKind::invalid_argument,
                    option + " must be three numbers, X,Y,Z, as in 1,2.5,-3; not '" + text + "'");
    }
    return {numbers[0], numbers[1], numbers[2]};
}

void add_point(CLI::App& command, const std::string& option, std::optional<nearlight::Vec3>& point,
               const std::string& description) {
    command
        .add_option_function<std::string>(
            option, [option, &point](const std::string& text) { point = point_of(option, text); },
            description)
        ->type_name("X,Y,Z");
}

}  // namespace

void add_camera_options(CLI::App& command, CameraOptions& options) {
    add_point(command, "--origin", options.origin,
              "Where the camera stands, instead of the scene's own place");
    add_point(command, "--target", options.target,
              "What the camera looks at: a point in the middle of the picture");
    add_point(command, "--up", options.up, "The direction that is upwards in the picture");
    command
        .add_option("--fov", options.fov_x_degrees,
                    "Horizontal field of view in degrees; makes an orthographic camera a perspective one")
        ->type_name("DEG");
}

std::optional<CameraPose> chosen_camera(const CameraOptions& options, const CameraPose& own) {
    if (!options.origin && !options.target && !options.up && !options.fov_x_degrees) {
        return std::nullopt;
    }
    CameraPose pose{.origin = options.origin.value_or(own.origin), .target = own.target, .up = own.up};
    if (options.target) {
        pose.target = *options.target;
    } else if (options.origin) {
        pose.target = {own.target.x + pose.origin.x - own.origin.x,
                       own.target.y + pose.origin.y - own.origin.y,
                       own.target.z + pose.origin.z - own.origin.z};
    }
    if (options.up) {
        pose.up = options.up;
    }
    pose.fov_x_degrees = options.fov_x_degrees;
    return pose;
}

std::optional<CameraPose> chosen_camera(const CameraOptions& options, const Scene& scene) {
    return chosen_camera(options, pose_of(scene.camera));
}

}  // namespace nearlight::core
