// SPDX-License-Identifier: Apache-2.0
#include "viewer/controls.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace nearlight::viewer {
namespace {

/// A drag over the whole width of the picture turns the camera by this angle, in radians.
constexpr float kOrbitAngle = std::numbers::pi_v<float>;
constexpr float kDefaultFieldOfView = 60.0f;
constexpr float kWheelStep = 1.15f;
constexpr float kHurry = 4.0f;
/// A frame of the window that took longer, as when the program was stopped, counts as this long.
constexpr float kMaxSeconds = 0.1f;

/// When the view looks about, a drag over the whole width of the picture turns it by this angle, in radians,
/// so that what is under the mouse stays there.
float look_angle(const FreeCamera& camera) {
    const double degrees = camera.fov_degrees > 0.0 ? camera.fov_degrees : kDefaultFieldOfView;
    return static_cast<float>(degrees * std::numbers::pi / 180.0);
}

FreeCamera dragged(const FreeCamera& camera, const Input& input) {
    switch (input.drag) {
        case Input::Drag::orbit:
            return orbit(camera, -input.drag_x * kOrbitAngle, input.drag_y * kOrbitAngle);
        case Input::Drag::look:
            return look_about(camera, -input.drag_x * look_angle(camera), input.drag_y * look_angle(camera));
        case Input::Drag::pan:
            return pan(camera, -input.drag_x, input.drag_y);
        case Input::Drag::none:
            break;
    }
    return camera;
}

}  // namespace

FreeCamera moved(const FreeCamera& camera, const Input& input, float metres_per_second) {
    FreeCamera result = camera;
    if (input.drag_x != 0.0f || input.drag_y != 0.0f) {
        result = dragged(result, input);
    }
    if (input.wheel != 0.0f) {
        result = approach(result, std::pow(kWheelStep, input.wheel));
    }
    if (is_walking(input)) {
        const float step =
            metres_per_second * (input.hurries ? kHurry : 1.0f) * std::min(input.seconds, kMaxSeconds);
        result = walk(result, step * static_cast<float>(input.right),
                      step * static_cast<float>(input.upwards), step * static_cast<float>(input.ahead));
    }
    return result;
}

}  // namespace nearlight::viewer
