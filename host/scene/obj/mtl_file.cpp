// SPDX-License-Identifier: Apache-2.0
#include "host/scene/obj/mtl_file.h"

#include <algorithm>
#include <cctype>
#include <istream>
#include <iterator>
#include <optional>

#include "host/base/words.h"
#include "host/scene/file_text.h"
#include "host/scene/number_text.h"
#include "host/scene/obj/obj_extras.h"
#include "nearlight/error.h"

namespace nearlight::core {
namespace {

/// What lines of an entry may begin with, without a note that they are left out. Ambient light (Ka, map_Ka)
/// says nothing of a surface in a scene whose light is computed, map_aat is about pixels, and sharpness about
/// the pictures of reflections alone, which have a note.
constexpr std::string_view kStatements[] = {
    "newmtl", "Ka",     "Kd",     "Ks",     "Ke",     "Kt",       "Tf",      "Tr",       "d",
    "Ns",     "Ni",     "illum",  "Pr",     "Pm",     "Ps",       "Pc",      "Pcr",      "aniso",
    "anisor", "map_Ka", "map_Kd", "map_Ks", "map_Ke", "map_d",    "map_Tr",  "map_Bump", "bump",
    "norm",   "map_Ns", "map_Pr", "map_Pm", "disp",   "map_Disp", "map_aat", "sharpness"};

/// Statements that begin with a number.
constexpr std::string_view kNumberStatements[] = {"Kd", "Ks", "Ke", "Kt",    "Tf", "Tr",
                                                  "d",  "Ns", "Ni", "illum", "Pr", "Pm"};

/// Whether the statement says something of a surface, and ends with the name of an image.
bool names_image(std::string_view statement) {
    const bool is_map = statement.starts_with("map_") && statement != "map_aat" && statement != "map_Ka";
    return is_map || statement == "bump" || statement == "norm" || statement == "disp";
}

/// Spells the words that lines begin with as tinyobjloader knows them, because programs differ in the case of
/// letters, and puts a blank behind them, where some have a tab.
void tidy_statements(std::string& text) {
    for_each_line(text, [&](int, std::string_view line) {
        const std::string_view word = first_word(line);
        const auto known = std::ranges::find_if(
            kStatements, [&](std::string_view statement) { return equal_in_any_case(statement, word); });
        if (known != std::end(kStatements)) {
            char* const begin = text.data() + (word.data() - text.data());
            std::ranges::copy(*known, begin);
            if (begin[word.size()] == '\t') {
                begin[word.size()] = ' ';
            }
        }
        return true;
    });
}

/// Whether the word can begin a statement; what cannot comes from files that are no material libraries.
bool looks_like_statement(std::string_view word) {
    const auto is_usual = [](char c) { return c == '_' || std::isalnum(static_cast<unsigned char>(c)) != 0; };
    return !word.empty() && std::isalpha(static_cast<unsigned char>(word.front())) != 0 &&
           std::ranges::all_of(word, is_usual);
}

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

/// A line of one number for a colour, whose green and blue are then the same as its red; other lines are
/// returned as they are.
std::string with_whole_color(std::string_view line) {
    for (const std::string_view statement : {"Ka", "Kd", "Ks", "Ke", "Kt", "Tf"}) {
        if (starts_with_word(line, statement)) {
            const std::vector<std::string> words = split(value_after(line, statement), ' ');
            if (words.size() == 1 && is_number(words[0])) {
                return std::string(statement) + " " + words[0] + " " + words[0] + " " + words[0];
            }
        }
    }
    return std::string(line);
}

/// Gives the options -s, -o and -t of textures three numbers, where they have one or two, because
/// tinyobjloader takes the name of the file for a missing one, and colours of one number three. The option
/// -halo goes behind its number, because tinyobjloader takes it for the number, and -cc, which it takes for
/// the name of a file, goes altogether.
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
            completed.append(with_whole_color(line)).append("\n");
            return true;
        }
        const std::vector<std::string> words = split(line, ' ');
        for (std::size_t i = 0; i < words.size(); ++i) {
            if (words[i] == "-cc" && i + 1 < words.size()) {
                ++i;
                continue;
            }
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
    tidy_lines(library.text);
    library.blenders_exponent = blenders_exponent(library.text, text_of_obj);
    tidy_statements(library.text);
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
/// its words if there is a file for one of them. Files that have moved count if nothing is where it should
/// be.
std::vector<std::string> names_in(const std::string& text, const std::filesystem::path& obj) {
    std::error_code ignored;
    const auto is_there = [&](const std::string& name) {
        return !name.empty() && std::filesystem::exists(resolve_path(obj, name), ignored);
    };
    const auto has_moved = [&](const std::string& name) {
        return !name.empty() && std::filesystem::exists(find_moved_file(obj, name), ignored);
    };
    std::vector<std::string> words = split(text, ' ');
    std::erase(words, "");
    if (is_there(text)) {
        return {text};
    }
    const bool are_names =
        std::ranges::any_of(words, is_there) || (!has_moved(text) && std::ranges::any_of(words, has_moved));
    return are_names ? words : std::vector{text};
}

}  // namespace

std::vector<MaterialLibrary> read_libraries(const ObjFile& obj, NoteSink& notes) {
    std::vector<MaterialLibrary> libraries;
    for (const auto& [line, text] : obj.libraries) {
        for (const std::string& name : names_in(text, obj.mesh.source)) {
            if (std::optional<MaterialLibrary> library =
                    read_library(find_moved_file(obj.mesh.source, name), obj.text)) {
                libraries.push_back(std::move(*library));
            } else {
                notes.approximation(obj.mesh.source, line,
                                    "material library '" + name + "' cannot be read; its materials are grey");
            }
        }
    }
    return libraries;
}

const MaterialLibrary* find_library(const std::vector<MaterialLibrary>& libraries, const std::string& name) {
    const auto found = std::ranges::find_if(
        libraries, [&](const MaterialLibrary& library) { return library.names.contains(name); });
    return found == libraries.end() ? nullptr : &*found;
}

std::string known_name(const std::vector<MaterialLibrary>& libraries, const std::string& name) {
    if (find_library(libraries, name) == nullptr) {
        for (std::size_t end = name.rfind(" #"); end != std::string::npos && end > 0;
             end = name.rfind(" #", end - 1)) {
            const std::string start = name.substr(0, name.find_last_not_of(" \t", end) + 1);
            if (find_library(libraries, start) != nullptr) {
                return start;
            }
        }
    }
    return name;
}

void note_unknown_statements(const MaterialLibrary& library, TextLine begin, NoteSink& notes) {
    if (begin.number == 0) {
        return;
    }
    for_each_line(std::string_view(library.text).substr(begin.begin), [&](int number, std::string_view line) {
        if (number > 1 && starts_with_word(line, "newmtl")) {
            return false;
        }
        const std::string_view word = first_word(line);
        if (looks_like_statement(word) && std::ranges::find(kStatements, word) == std::end(kStatements) &&
            !value_after(line, word).empty()) {
            notes.approximation(library.file, begin.number + number - 1,
                                "statement '" + std::string(word) + "' of OBJ materials is left out");
        }
        const std::string value = value_after(line, word);
        if (std::ranges::find(kNumberStatements, word) != std::end(kNumberStatements) &&
            !is_number(std::string(first_word(value)))) {
            notes.approximation(library.file, begin.number + number - 1,
                                "statement '" + std::string(word) + "' without a number, which counts as 0");
        }
        if (names_image(word) && value.empty()) {
            notes.remark(library.file, begin.number + number - 1,
                         "statement '" + std::string(word) + "' without the name of a file");
        }
        return true;
    });
}

}  // namespace nearlight::core
