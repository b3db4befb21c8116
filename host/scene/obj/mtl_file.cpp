// SPDX-License-Identifier: Apache-2.0
#include "host/scene/obj/mtl_file.h"

#include <algorithm>
#include <istream>
#include <optional>

#include "host/base/words.h"
#include "host/scene/file_text.h"
#include "host/scene/number_text.h"
#include "host/scene/obj/obj_extras.h"
#include "nearlight/error.h"

namespace nearlight::core {
namespace {

// Some releases of tinyobjloader cut the names of materials at the first blank, so they are read from the
// text.
void restore_names(MaterialLibrary& library) {
    std::vector<std::string> names;
    for_each_line(library.text, [&](int, std::string_view line) {
        if (starts_with_word(line, "newmtl")) {
            const std::string name = value_after(line, "newmtl");
            if (!name.empty()) {
                names.push_back(name);
            }
        }
        return true;
    });
    if (names.size() != library.materials.size()) {
        return;
    }
    library.names.clear();
    for (std::size_t i = 0; i < names.size(); ++i) {
        library.names.emplace(names[i], static_cast<int>(i));
        library.materials[i].name = names[i];
    }
}

/// A texture of the highlight's colour alone gives it, as those of other colours do. Mirrors (illum 3 and 5),
/// of which such a texture is left out, would mirror all light.
void complete_highlights(MaterialLibrary& library) {
    for (tinyobj::material_t& entry : library.materials) {
        const auto begin = library.lines.find(entry.name);
        if (!entry.specular_texname.empty() && entry.illum != 3 && entry.illum != 5 &&
            begin != library.lines.end() &&
            find_in_block(library.text, begin->second, "newmtl", "Ks", "") == 0) {
            std::ranges::fill(entry.specular, 1.0f);
        }
    }
}

bool is_number(const std::string& word) {
    return number_in(word).has_value();
}

/// Gives the options -s, -o and -t of textures three numbers, where they have one or two, because
/// tinyobjloader takes the name of the file for a missing one. The option -halo goes behind its number,
/// because tinyobjloader takes it for the number.
void complete_options(std::string& text) {
    std::string completed;
    for_each_line(text, [&](int, std::string_view line) {
        if (starts_with_word(line, "d") && value_after(line, "d").starts_with("-halo ")) {
            completed.append("d " + value_after(line, "d").substr(6) + " -halo\n");
            return true;
        }
        const bool is_map = line.find("map_") != std::string_view::npos || starts_with_word(line, "bump") ||
                            starts_with_word(line, "norm");
        if (!is_map || line.find(" -") == std::string_view::npos) {
            completed.append(line).append("\n");
            return true;
        }
        const std::vector<std::string> words = split(line, ' ');
        for (std::size_t i = 0; i < words.size(); ++i) {
            completed += (i == 0 ? "" : " ") + words[i];
            if (words[i] != "-s" && words[i] != "-o" && words[i] != "-t") {
                continue;
            }
            const char* const rest = words[i] == "-s" ? " 1" : " 0";
            std::size_t numbers = 0;
            for (; numbers < 3 && i + 1 < words.size() && is_number(words[i + 1]); ++numbers) {
                completed += " " + words[++i];
            }
            for (; numbers > 0 && numbers < 3; ++numbers) {
                completed += rest;
            }
        }
        completed += "\n";
        return true;
    });
    text = std::move(completed);
}

/// MaterialLibrary::blenders_exponent. From Blender 3 on, libraries begin with "# Blender 3.3.1 MTL File".
/// Before, only the OBJ file beside them told the version, and those before 2.80 meant other things.
float blenders_exponent(std::string_view text, std::string_view text_of_obj) {
    constexpr std::string_view kBeginning = "# Blender ";
    if (!text.starts_with(kBeginning) || text.size() == kBeginning.size()) {
        return 0.0f;
    }
    const char first = text[kBeginning.size()];
    if (first >= '0' && first <= '9') {
        return 1000.0f;
    }
    const bool is_late =
        text_of_obj.starts_with("# Blender v2.8") || text_of_obj.starts_with("# Blender v2.9");
    return is_late ? 900.0f : 0.0f;
}

/// Empty if the file cannot be read.
std::optional<MaterialLibrary> read_library(const std::filesystem::path& file, std::string_view text_of_obj) {
    MaterialLibrary library;
    library.file = file;
    try {
        library.text = read_file_text(file);
    } catch (const Error&) {
        return std::nullopt;
    }
    library.blenders_exponent = blenders_exponent(library.text, text_of_obj);
    tidy_lines(library.text);
    complete_options(library.text);
    TextBuffer buffer(library.text);
    std::istream stream(&buffer);
    std::string warning;
    std::string error;
    tinyobj::LoadMtl(&library.names, &library.materials, &stream, &warning, &error);
    restore_names(library);
    library.lines = lines_by_value(library.text, "newmtl");
    complete_highlights(library);
    return library;
}

/// The libraries that a line names: the text as a whole, whose blanks may be those of a file's name, or else
/// its words if there is a file for one of them.
std::vector<std::string> names_in(const std::string& text, const std::filesystem::path& obj) {
    std::error_code ignored;
    const auto is_there = [&](const std::string& name) {
        return !name.empty() && std::filesystem::exists(resolve_path(obj, name), ignored);
    };
    std::vector<std::string> words = split(text, ' ');
    std::erase(words, "");
    return !is_there(text) && std::ranges::any_of(words, is_there) ? words : std::vector{text};
}

}  // namespace

std::vector<MaterialLibrary> read_libraries(const ObjFile& obj, NoteSink& notes) {
    std::vector<MaterialLibrary> libraries;
    for (const auto& [line, text] : obj.libraries) {
        for (const std::string& name : names_in(text, obj.mesh.source)) {
            if (std::optional<MaterialLibrary> library =
                    read_library(resolve_path(obj.mesh.source, name), obj.text)) {
                libraries.push_back(std::move(*library));
            } else {
                notes.approximation(obj.mesh.source, line,
                                    "material library '" + name + "' cannot be read; its materials are grey");
            }
        }
    }
    return libraries;
}

}  // namespace nearlight::core
