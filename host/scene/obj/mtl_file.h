// SPDX-License-Identifier: Apache-2.0
// Reads the material libraries of OBJ files (MTL).
#pragma once

#include <tiny_obj_loader.h>

#include <filesystem>
#include <map>
#include <string>
#include <unordered_map>
#include <vector>

#include "host/scene/note_sink.h"
#include "host/scene/obj/obj_file.h"
#include "host/scene/obj/obj_text.h"

namespace nearlight::core {

/// A material library, with its text for line numbers.
struct MaterialLibrary {
    std::filesystem::path file;
    std::string text;
    std::unordered_map<std::string, TextLine> lines;  ///< where materials begin
    std::map<std::string, int> names;                 ///< indices into `materials`
    std::vector<tinyobj::material_t> materials;
    /// Ns of smooth surfaces where the exporter of Blender 2.80 or later wrote the file, which gives Ns and
    /// Ka meanings of their own; 0 elsewhere.
    float blenders_exponent = 0;

    /// The entry of that name, which there must be.
    [[nodiscard]] const tinyobj::material_t& entry(const std::string& name) const {
        return materials[static_cast<std::size_t>(names.at(name))];
    }
    [[nodiscard]] bool is_blenders() const { return blenders_exponent > 0; }
};

/// The libraries that the file names and that can be read; notes tell the others. A line may name one
/// library, whose name may hold blanks, or several.
std::vector<MaterialLibrary> read_libraries(const ObjFile& obj, NoteSink& notes);

/// The first library with an entry of that name, or null.
const MaterialLibrary* find_library(const std::vector<MaterialLibrary>& libraries, const std::string& name);

/// The name of a material without a comment behind it (" #"), if no library has an entry of the whole name
/// and one has that. Names may have a # in them.
std::string known_name(const std::vector<MaterialLibrary>& libraries, const std::string& name);

/// Notes each kind of statement that the entry at `begin` has and that is left out although it may change the
/// look, or that lacks its number or the name of its image. What has a note of its own (displacement, sheen,
/// clear coat, anisotropy, map_Ns) is not among them.
void note_unknown_statements(const MaterialLibrary& library, TextLine begin, NoteSink& notes);

}  // namespace nearlight::core
