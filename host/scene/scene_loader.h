// SPDX-License-Identifier: Apache-2.0
// Reads scenes of every format.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "host/scene/scene.h"
#include "host/scene/scene_overrides.h"

namespace nearlight::core {

/// A moment of the animations that a file has.
struct SceneMoment {
    /// Before the first key of a motion it has not begun, and after the last it has ended.
    double seconds = 0;
    /// The animations to play: their names, or their numbers counted from 1. Empty: all but those that move
    /// what an earlier one moves.
    std::vector<std::string> animations{};
};

struct LoadOptions {
    /// Values of `$name` in Mitsuba XML, which win over <default>.
    std::map<std::string, std::string> parameters{};
    /// The camera to take: its name, or its number counted from 1; empty: the first one.
    std::string camera{};
    SceneOverrides overrides{};
    std::optional<SceneMoment> moment{};  ///< empty: the file's nodes are at rest
    bool lists_animations = false;        ///< whether Scene::animations is filled
    /// Every approximation is an error instead of a note.
    bool strict = false;
};

/// Reads a scene in the format that its extension tells: .xml (Mitsuba 0.5 to 3), .gltf and .glb (glTF 2.0),
/// .obj, .ply. Throws Error(ErrorKind::file) with file and line if the file is missing, broken or holds
/// something unknown, and Error(ErrorKind::invalid_argument) for a camera, a parameter or an animation that
/// is not there, or as apply_overrides().
Scene load_scene(const std::filesystem::path& file, const LoadOptions& options = {});

/// The camera that the file of `scene` has at the moment of `options`; all other options are those that the
/// scene was loaded with. Nothing if surfaces or lights stand elsewhere then. Takes less time than loading
/// the scene. Throws as load_scene().
std::optional<SceneCamera> camera_at(const Scene& scene, const LoadOptions& options);

}  // namespace nearlight::core
