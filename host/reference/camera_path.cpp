// SPDX-License-Identifier: Apache-2.0
#include "host/reference/camera_path.h"

namespace nearlight::core {

CameraRays::CameraRays(const SceneCamera& camera, int width, int height)
    : to_world_(camera.to_world),
      tan_x_(std::tan(camera.fov_x_degrees * std::numbers::pi / 360.0)),
      tan_y_(tan_x_ * height / width),
      width_(width),
      height_(height) {}

Ray CameraRays::through(float x, float y) const {
    const Vec3 direction{static_cast<float>((1.0 - 2.0 * x / width_) * tan_x_),
                         static_cast<float>((1.0 - 2.0 * y / height_) * tan_y_), 1.0f};
    return {transform_point(to_world_, {0, 0, 0}), normalize(transform_vector(to_world_, direction))};
}

}  // namespace nearlight::core
