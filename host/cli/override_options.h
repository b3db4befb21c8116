// SPDX-License-Identifier: Apache-2.0
// Camera and light of a scene of any format, from the command line.
#pragma once

#include <string>
#include <vector>

#include "host/cli/scene_options.h"

namespace nearlight::core {

/// Adds --camera, --origin, --target, --up, --fov, --environment, --environment-rotation,
/// --environment-scale, --sun and --light-scale. What is not a list of numbers throws
/// Error(ErrorKind::invalid_argument).
void add_override_options(CLI::App& command, SceneOptions& options);

/// The arguments that say the same about light, and which of its cameras the scene is seen with.
std::vector<std::string> override_arguments(const SceneOptions& options);

}  // namespace nearlight::core
