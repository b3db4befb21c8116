// SPDX-License-Identifier: Apache-2.0
// The options by which a command takes its scene.
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

/// The positional SCENE, -D and --strict.
void add_scene_options(CLI::App& command, SceneOptions& options);
/// -D and --strict alone, for commands that take several scenes.
void add_shared_scene_options(CLI::App& command, SceneOptions& options);

/// --bvh fast|quality; `quality` holds the default.
void add_bvh_option(CLI::App& command, BvhQuality& quality);

/// Throws Error(ErrorKind::invalid_argument) for a definition without a name or a '='.
LoadOptions load_options(const SceneOptions& options);

/// Reads the scene and tells its notes as warnings.
Scene load_scene(const SceneOptions& options);

}  // namespace nearlight::core
