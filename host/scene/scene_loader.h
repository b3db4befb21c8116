// SPDX-License-Identifier: Apache-2.0
// Reads a scene, whatever its format.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "host/scene/scene.h"

namespace nearlight::core {

struct LoadOptions {
    /// Values for `$name` in Mitsuba XML; they win over <default>. Of glTF files, `camera`.
    std::map<std::string, std::string> parameters;
    /// Every approximation is an error instead of a note.
    bool strict = false;
};

/// By extension: .xml (Mitsuba 0.5 to 3), .gltf and .glb (glTF 2.0), .obj. Throws Error(ErrorKind::file) with
/// file and line where the file is missing, broken or holds something unknown.
Scene load_scene(const std::filesystem::path& file, const LoadOptions& options = {});

}  // namespace nearlight::core
