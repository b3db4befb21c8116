// SPDX-License-Identifier: Apache-2.0
// The options by which a command chooses its scene.
#pragma once

#include <filesystem>
#include <optional>
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
    std::optional<FilterKind> filter;  ///< reconstruction filter; empty: the scene's
    bool clear_glass = false;
    std::string camera;  ///< name or number; empty: the first one
    SceneOverrides overrides;
    std::optional<SceneMoment> moment{};  ///< of the file's animations; empty: at rest
    bool lists_animations = false;        ///< whether Scene::animations is filled
};

/// Adds the positional SCENE, -D, --strict and the options of override_options.h.
void add_scene_options(CLI::App& command, SceneOptions& options);
/// Adds all but SCENE, for commands that take several scenes.
void add_shared_scene_options(CLI::App& command, SceneOptions& options);

/// Adds --filter NAME. Any other name throws Error(ErrorKind::invalid_argument).
void add_filter_option(CLI::App& command, std::optional<FilterKind>& filter);

/// Adds --glass refract|clear.
void add_glass_option(CLI::App& command, bool& clear_glass);
/// What --glass was, for metadata and JSON.
std::string glass_name(bool clear_glass);

/// Adds --bvh fast|quality; `quality` has the default.
void add_bvh_option(CLI::App& command, BvhQuality& quality);

/// Makes the loader's options. Throws Error(ErrorKind::invalid_argument) for a definition without a name or a
/// '='.
LoadOptions load_options(const SceneOptions& options);

/// Reads the scene, with the filter and the glass that the options say, and logs its notes as warnings.
Scene load_scene(const SceneOptions& options);

/// The camera that the scene has at the options' moment, as camera_at() of scene_loader.h.
std::optional<SceneCamera> camera_at(const Scene& scene, const SceneOptions& options);

}  // namespace nearlight::core
