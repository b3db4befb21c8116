// SPDX-License-Identifier: Apache-2.0
// The options by which a command chooses its scene.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "host/bvh/bvh.h"
#include "host/cli/command.h"
#include "host/scene/scene_loader.h"

namespace nearlight::core {

struct SceneOptions {
    std::filesystem::path file;
    std::vector<std::string> definitions;  ///< "name=value"
    bool strict = false;
};

/// Adds the positional SCENE, -D and --strict.
void add_scene_options(CLI::App& command, SceneOptions& options);
/// Adds -D and --strict alone, for commands that take several scenes.
void add_shared_scene_options(CLI::App& command, SceneOptions& options);

/// Adds --bvh fast|quality; `quality` has the default.
void add_bvh_option(CLI::App& command, BvhQuality& quality);

/// Makes the loader's options. Throws Error(ErrorKind::invalid_argument) for a definition without a name or a
/// '='.
LoadOptions load_options(const SceneOptions& options);

/// Reads the scene and logs its notes as warnings.
Scene load_scene(const SceneOptions& options);

}  // namespace nearlight::core
