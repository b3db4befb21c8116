// SPDX-License-Identifier: Apache-2.0
#include "host/scene/pinhole_camera.h"

namespace nearlight {

PinholeCamera make_pinhole_camera(const SceneCamera& camera, int width, int height) {
    const auto tan_x = static_cast<float>(std::tan(camera.fov_x_degrees * std::numbers::pi / 360.0));
    const float tan_y = tan_x * static_cast<float>(height) / static_cast<float>(width);
    // +X of the camera points to the left of the picture, so the left edge is at +tan_x.
    const Vec3 left = transform_vector(camera.to_world, {tan_x, 0, 0});
    const Vec3 up = transform_vector(camera.to_world, {0, tan_y, 0});
    const Vec3 forward = transform_vector(camera.to_world, {0, 0, 1});
    return {.origin = transform_point(camera.to_world, {0, 0, 0}),
            .width = static_cast<uint>(width),
            .corner = forward + left + up,
            .height = static_cast<uint>(height),
            .step_x = left * (-2.0f / static_cast<float>(width)),
            .pad0 = 0,
            .step_y = up * (-2.0f / static_cast<float>(height)),
            .pad1 = 0};
}

}  // namespace nearlight
