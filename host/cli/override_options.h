// SPDX-License-Identifier: Apache-2.0
// Camera and light of a scene of any format, from the command line.
#pragma once

#include "host/cli/scene_options.h"

namespace nearlight::core {

/// Adds --camera, --origin, --target, --fov, --environment, --environment-rotation, --environment-scale,
/// --sun and --light-scale. What is not a list of numbers throws Error(ErrorKind::invalid_argument).
void add_override_options(CLI::App& command, SceneOptions& options);

}  // namespace nearlight::core
