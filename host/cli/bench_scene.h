// SPDX-License-Identifier: Apache-2.0
// The scene of a bench: a file, or one that is made up.
#pragma once

#include "host/cli/scene_options.h"

namespace nearlight::core {

/// SCENE, which need not be given.
void add_bench_scene_options(CLI::App& command, SceneOptions& options);

/// "spheres:N" is a made-up room of N triangles; anything else is a file. Error(usage) where N is no number
/// of triangles, or no scene was given.
Scene make_bench_scene(const SceneOptions& options);

}  // namespace nearlight::core
