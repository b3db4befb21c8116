// SPDX-License-Identifier: Apache-2.0
#include "host/scene/pinhole_camera.h"

#include <cmath>
#include <numbers>
#include <string>

#include "nearlight/error.h"

namespace nearlight::core {

PinholeCamera make_pinhole_camera(const SceneCamera& camera, int width, int height) {
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
    // Lengths are those on the plane at distance 1, where +X points to the left of the picture and +Y up.
    const double half_width = std::tan(camera.fov_x_degrees * std::numbers::pi / 360.0);
    const double pixel = 2.0 * half_width / width;
    const double half_height = 0.5 * pixel * height;
    const auto to_world = [&](double x, double y, double z) {
        return transform_vector(camera.to_world,
                                {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)});
    };
    PinholeCamera pinhole{};
    pinhole.origin = transform_point(camera.to_world, {0, 0, 0});
    pinhole.width = static_cast<uint>(width);
    pinhole.height = static_cast<uint>(height);
    pinhole.corner = to_world(half_width, half_height, 1.0);
    pinhole.step_x = to_world(-pixel, 0.0, 0.0);
    pinhole.step_y = to_world(0.0, -pixel, 0.0);
    return pinhole;
}

}  // namespace nearlight::core
