// SPDX-License-Identifier: Apache-2.0
// The scene of a benchmark: a file, or a generated one.
#pragma once

#include "host/cli/scene_options.h"

namespace nearlight::core {

/// Adds the options of add_scene_options(), where SCENE may be missing.
void add_bench_scene_options(CLI::App& command, SceneOptions& options);

/// Makes the scene. "spheres:N" is a generated room of N triangles; anything else is a file. Throws
/// Error(ErrorKind::invalid_argument) if N is not a number of triangles, or no scene was given.
Scene make_bench_scene(const SceneOptions& options);

}  // namespace nearlight::core
