// SPDX-License-Identifier: Apache-2.0
// What the user has set in the window.
#pragma once

#include <array>
#include <string>

#include "nearlight/settings.h"
#include "viewer/camera_motion.h"
#include "viewer/display.h"

namespace nearlight::viewer {

struct ViewerState {
    FreeCamera camera{};
    FreeCamera first_camera{};  ///< to return to
    RenderSettings settings{};
    DisplaySettings display{};
    bool shows_vpls = false;
    bool shows_hidden_vpls = false;
    bool is_paused = false;
    bool has_automatic_exposure = false;  ///< the next whole picture decides the exposure
    float walking_speed = 1.0f;           ///< m/s
    std::array<char, 256> save_name{"picture.exr"};
    std::string message{};  ///< what became of the latest action
};

/// What the user changed during one frame of the window.
struct Changes {
    bool camera = false;
    bool sampling = false;  ///< anything that VPLs or light depend on
    bool samples = false;   ///< the number of samples alone
    bool display = false;
    bool automatic_exposure = false;  ///< the picture that is shown is to decide the exposure
    bool pause = false;
    bool save = false;
    bool copy_command = false;
};

}  // namespace nearlight::viewer
