// SPDX-License-Identifier: Apache-2.0
// The options that place the camera.
#pragma once

#include <optional>

#include "host/cli/command.h"
#include "host/scene/scene.h"
#include "nearlight/settings.h"

namespace nearlight::core {

struct CameraOptions {
    std::optional<nearlight::Vec3> origin;
    std::optional<nearlight::Vec3> target;
    std::optional<nearlight::Vec3> up;
    std::optional<double> fov_x_degrees;
};

/// Adds --origin, --target, --up and --fov.
void add_camera_options(CLI::App& command, CameraOptions& options);

/// What the options leave of the scene's camera `own`: its direction, if there is an origin but no target,
/// and its field of view. Nothing if no option was given.
std::optional<CameraPose> chosen_camera(const CameraOptions& options, const CameraPose& own);
std::optional<CameraPose> chosen_camera(const CameraOptions& options, const Scene& scene);

}  // namespace nearlight::core
