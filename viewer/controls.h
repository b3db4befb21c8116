// SPDX-License-Identifier: Apache-2.0
// What mouse and keys do to the camera.
#pragma once

#include <optional>

#include "viewer/camera_motion.h"

namespace nearlight::viewer {

/// Input since the last frame of the window, in the terms of the picture.
struct Input {
    enum class Drag { none, orbit, look, pan };
    Drag drag = Drag::none;
    float drag_x = 0.0f;  ///< to the right, in parts of the picture's width
    float drag_y = 0.0f;  ///< downwards, in parts of the picture's width
    float wheel = 0.0f;   ///< notches towards the picture
    // Keys that are held: −1, 0 or 1.
    int right = 0;
    int upwards = 0;
    int ahead = 0;
    bool hurries = false;
    float seconds = 0.0f;  ///< since the last frame
};

/// The camera after the input; `metres_per_second` is the speed of walking.
FreeCamera moved(const FreeCamera& camera, const Input& input, float metres_per_second);

/// Whether keys are held that move the camera, so that the window is not to wait.
inline bool is_walking(const Input& input) {
    return input.right != 0 || input.upwards != 0 || input.ahead != 0;
}

}  // namespace nearlight::viewer
