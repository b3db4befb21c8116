// SPDX-License-Identifier: Apache-2.0
// Reads scenes of every format.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "host/scene/scene.h"
#include "host/scene/scene_overrides.h"

namespace nearlight::core {

struct LoadOptions {
    /// Values of `$name` in Mitsuba XML, which win over <default>.
    std::map<std::string, std::string> parameters{};
    /// The camera to take: its name, or its number counted from 1; empty: the first one.
    std::string camera{};
    SceneOverrides overrides{};
    /// Every approximation is an error instead of a note.
    bool strict = false;
};

/// Reads a scene in the format that its extension tells: .xml (Mitsuba 0.5 to 3), .gltf and .glb (glTF 2.0),
/// .obj. Throws Error(ErrorKind::file) with file and line if the file is missing, broken or holds something
/// unknown, and Error(ErrorKind::invalid_argument) for a camera or a parameter that is not there, or as
/// apply_overrides().
Scene load_scene(const std::filesystem::path& file, const LoadOptions& options = {});

}  // namespace nearlight::core
