// SPDX-License-Identifier: Apache-2.0
// A first look at the JSON of a glTF file, before anything is made of it.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace nearlight::core::gltf {

struct JsonSurvey {
    bool is_valid = false;
    std::size_t depth = 0;              ///< how deep arrays and objects are nested
    std::vector<std::string> required;  ///< what `extensionsRequired` names
    std::vector<std::string> used;      ///< what `extensionsUsed` names
    std::vector<std::string> images;    ///< URIs of files that images name; those that hold data are left out
    std::vector<std::string> buffers;   ///< and of those that buffers name
    bool is_version_1 = false;          ///< meshes, nodes or scenes have names in place of numbers
};

/// Reads the text once, in memory that does not grow with how deeply it is nested.
JsonSurvey survey_json(std::string_view text);

/// The JSON of a .gltf file, or the first chunk of a .glb; empty if a .glb is cut short.
std::string_view json_of(std::string_view file);

/// The file without the indices of compressed primitives, which tinygltf refuses because they have no buffer
/// view. The file must be valid.
std::string without_compressed_indices(std::string_view file);

/// The file with one byte in place of each buffer that stands in for compressed buffer views. Often there is
/// no such buffer, only its length, which tinygltf refuses. The file must be valid.
std::string without_fallback_buffers(std::string_view file);

}  // namespace nearlight::core::gltf
