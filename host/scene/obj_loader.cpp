// SPDX-License-Identifier: Apache-2.0
#include "host/scene/obj_loader.h"

#include <tiny_obj_loader.h>

#include <fstream>
#include <limits>
#include <sstream>
#include <streambuf>
#include <string_view>

#include "host/scene/default_view.h"
#include "host/scene/file_text.h"
#include "host/scene/material_model.h"
#include "host/scene/texture_loader.h"
#include "nearlight/error.h"

namespace nearlight::core {
namespace {

constexpr uint kNone = std::numeric_limits<uint>::max();

// An istream over text in memory, without a copy.
class TextBuffer : public std::streambuf {
  public:
    explicit TextBuffer(std::string& text) { setg(text.data(), text.data(), text.data() + text.size()); }
};

std::string trimmed(std::string_view text) {
    const std::size_t first = text.find_first_not_of(" \t\r\n");
    if (first == std::string_view::npos) {
        return {};
    }
    return std::string(text.substr(first, text.find_last_not_of(" \t\r\n") - first + 1));
}

// Calls visit(line number, line) until it returns false.
template <typename Visit>
void for_each_line(std::string_view text, Visit visit) {
    int number = 1;
    for (std::size_t begin = 0; begin < text.size(); ++number) {
        const std::size_t end = std::min(text.find('\n', begin), text.size());
        if (!visit(number, text.substr(begin, end - begin))) {
            return;
        }
        begin = end + 1;
    }
}

bool starts_with_word(std::string_view line, std::string_view word) {
    line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
    return line.size() > word.size() && line.starts_with(word) &&
           (line[word.size()] == ' ' || line[word.size()] == '\t');
}

// The number of the line `word … value`; 0 if there is none.
int find_line(std::string_view text, std::string_view word, std::string_view value) {
    int found = 0;
    for_each_line(text, [&](int number, std::string_view line) {
        if (starts_with_word(line, word) && line.find(value) != std::string_view::npos) {
            found = number;
        }
        return found == 0;
    });
    return found;
}

int line_of_face(std::string_view text, std::size_t face) {
    int found = 0;
    for_each_line(text, [&](int number, std::string_view line) {
        if (starts_with_word(line, "f") && face-- == 0) {
            found = number;
        }
        return found == 0;
    });
    return found;
}

// Takes tinyobjloader's callbacks and makes one vertex of each distinct (position, texture, normal) triple.
class ObjBuilder {
  public:
    explicit ObjBuilder(ObjFile& obj) : obj_(obj) { obj_.materials.emplace_back(); }

    void add_face(const tinyobj::index_t* corners, int count) {
        if (count < 3) {
            ++short_faces_;
            ++faces_;
            return;
        }
        const uint first = vertex(corners[0]);
        uint previous = vertex(corners[1]);
        for (int i = 2; i < count; ++i) {
            const uint next = vertex(corners[i]);
            obj_.mesh.triangles.push_back({first, previous, next});
            obj_.mesh.groups.push_back(group_);
            previous = next;
        }
        ++faces_;
    }
    void use_material(const std::string& name) {
        const auto found = std::find(obj_.materials.begin(), obj_.materials.end(), name);
        group_ = static_cast<uint>(found - obj_.materials.begin());
        if (found == obj_.materials.end()) {
            obj_.materials.push_back(name);
        }
    }
    void finish() {
        if (!any_normal_) {
            obj_.mesh.normals.clear();
        }
        if (!any_uv_) {
            obj_.mesh.uvs.clear();
        }
    }

    std::vector<Vec3> positions, normals;
    std::vector<std::array<float, 2>> uvs;
    [[nodiscard]] std::size_t short_faces() const { return short_faces_; }

  private:
    struct Corner {
        uint uv, normal, vertex, next;
    };

    // OBJ counts from 1, or back from the last element. The index 0 means "not given", which is an error for
    // a position.
    uint resolve(int index, std::size_t count, const char* what, bool required) const {
        const auto signed_count = static_cast<long long>(count);
        const long long at = index > 0 ? index - 1LL : signed_count + index;
        if (index == 0 && !required) {
            return kNone;
        }
        if (index == 0 || at < 0 || at >= signed_count) {
            throw Error(ErrorKind::file, obj_.mesh.source.string() + ":" +
                                             std::to_string(line_of_face(obj_.text, faces_)) +
                                             ": face refers to " + what + " " + std::to_string(index) +
                                             ", but there are only " + std::to_string(count) + " so far");
        }
        return static_cast<uint>(at);
    }

    uint vertex(const tinyobj::index_t& index) {
        const uint p = resolve(index.vertex_index, positions.size(), "vertex", true);
        const uint t = resolve(index.texcoord_index, uvs.size(), "texture coordinate", false);
        const uint n = resolve(index.normal_index, normals.size(), "normal", false);
        if (chains_.size() < positions.size()) {
            chains_.resize(positions.size(), kNone);
        }
        for (uint c = chains_[p]; c != kNone; c = corners_[c].next) {
            if (corners_[c].uv == t && corners_[c].normal == n) {
                return corners_[c].vertex;
            }
        }
        const auto made = static_cast<uint>(obj_.mesh.positions.size());
        corners_.push_back({t, n, made, chains_[p]});
        chains_[p] = static_cast<uint>(corners_.size() - 1);
        obj_.mesh.positions.push_back(positions[p]);
        obj_.mesh.uvs.push_back(t == kNone ? std::array<float, 2>{0, 0} : uvs[t]);
        obj_.mesh.normals.push_back(n == kNone ? Vec3{0, 0, 0} : normals[n]);
        any_uv_ = any_uv_ || t != kNone;
        any_normal_ = any_normal_ || n != kNone;
        return made;
    }

    ObjFile& obj_;
    std::vector<uint> chains_;  // the first corner of each position
    std::vector<Corner> corners_;
    std::size_t faces_ = 0, short_faces_ = 0;
    uint group_ = 0;
    bool any_uv_ = false, any_normal_ = false;
};

tinyobj::callback_t make_callbacks() {
    tinyobj::callback_t callbacks;
    callbacks.vertex_cb = [](void* user, float x, float y, float z, float) {
        static_cast<ObjBuilder*>(user)->positions.push_back({x, y, z});
    };
    callbacks.normal_cb = [](void* user, float x, float y, float z) {
        static_cast<ObjBuilder*>(user)->normals.push_back({x, y, z});
    };
    callbacks.texcoord_cb = [](void* user, float x, float y, float) {
        static_cast<ObjBuilder*>(user)->uvs.push_back({x, y});
    };
    callbacks.index_cb = [](void* user, tinyobj::index_t* corners, int count) {
        static_cast<ObjBuilder*>(user)->add_face(corners, count);
    };
    callbacks.usemtl_cb = [](void* user, const char* name, int) {
        static_cast<ObjBuilder*>(user)->use_material(trimmed(name));
    };
    return callbacks;
}

// A material library, with its text for line numbers.
struct MaterialLibrary {
    std::filesystem::path file;
    std::string text;
    std::map<std::string, int> names;
    std::vector<tinyobj::material_t> materials;
};

// Some releases of tinyobjloader cut the names of materials at the first blank, so they are read from the
// text.
void restore_names(MaterialLibrary& library) {
    std::vector<std::string> names;
    for_each_line(library.text, [&](int, std::string_view line) {
        if (starts_with_word(line, "newmtl")) {
            const std::string name = trimmed(line.substr(line.find("newmtl") + 6));
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

std::vector<MaterialLibrary> read_libraries(const ObjFile& obj, NoteSink& notes) {
    std::vector<MaterialLibrary> libraries;
    for (const std::string& name : obj.libraries) {
        MaterialLibrary library;
        library.file = resolve_path(obj.mesh.source, name);
        try {
            library.text = read_file_text(library.file);
        } catch (const Error&) {
            notes.approximation(obj.mesh.source, find_line(obj.text, "mtllib", name),
                                "material library '" + name + "' cannot be read; its materials are grey");
            continue;
        }
        TextBuffer buffer(library.text);
        std::istream stream(&buffer);
        std::string warning;
        std::string error;
        tinyobj::LoadMtl(&library.names, &library.materials, &stream, &warning, &error);
        restore_names(library);
        libraries.push_back(std::move(library));
    }
    return libraries;
}

Vec3 to_vec3(const tinyobj::real_t (&c)[3]) {
    return {c[0], c[1], c[2]};
}

Vec3 clamped(Vec3 c) {
    return min(max(c, {0, 0, 0}), {1, 1, 1});
}

bool is_glass(const tinyobj::material_t& source) {
    return source.illum == 4 || source.illum == 6 || source.illum == 7;
}

bool is_mirror(const tinyobj::material_t& source) {
    return source.illum == 3 || source.illum == 5;
}

// A material library's entry, and where notes of it point.
struct MaterialSource {
    const MaterialLibrary& library;
    const tinyobj::material_t& entry;
    int line;
};

class ObjMaterials {
  public:
    ObjMaterials(Scene& scene, NoteSink& notes) : scene_(scene), notes_(notes), textures_(scene, notes) {}

    // The index of the material.
    uint add(const MaterialSource& source) {
        warn_of_what_is_left_out(source);
        const Parameter emission = parameter_of(max(to_vec3(source.entry.emission), {0, 0, 0}));
        if (is_glass(source.entry)) {
            approximate(source, "a transparent material is rendered as a thin pane of glass");
            Material pane = thin_dielectric_material(
                static_cast<double>(source.entry.ior > 1.001f ? source.entry.ior : 1.5f));
            pane.emission = emission;
            scene_.materials.push_back(pane);
            return static_cast<uint>(scene_.materials.size() - 1);
        }
        Material side = is_mirror(source.entry) ? mirror(source) : diffuse(source);
        side.emission = emission;
        return add_mask(source, add_two_sided(scene_, side));
    }

    uint add_grey() { return add_two_sided(scene_, diffuse_material({0.5f, 0.5f, 0.5f})); }

  private:
    void approximate(const MaterialSource& source, const std::string& what) {
        notes_.approximation(source.library.file, source.line, what);
    }

    void warn_of_what_is_left_out(const MaterialSource& source) {
        if (!source.entry.bump_texname.empty() || !source.entry.displacement_texname.empty() ||
            !source.entry.normal_texname.empty()) {
            approximate(source, "bump, displacement and normal maps of OBJ materials are left out");
        }
        if (source.entry.roughness > 0 || source.entry.metallic > 0 ||
            !source.entry.roughness_texname.empty() || !source.entry.metallic_texname.empty()) {
            approximate(source, "roughness and metalness (Pr, Pm) of OBJ materials are left out");
        }
    }

    int load(const MaterialSource& source, const std::string& name, const char* keyword,
             const TexelRule& rule) {
        return textures_.load(resolve_path(source.library.file, name), rule, source.library.file,
                              find_line(source.library.text, keyword, name));
    }

    Material mirror(const MaterialSource& source) {
        approximate(source, "a reflecting material (illum 3 or 5) is rendered as a perfect mirror");
        return conductor_material({0, 0, 0}, {1, 1, 1}, clamped(to_vec3(source.entry.specular)));
    }

    Material diffuse(const MaterialSource& source) {
        const Vec3 given = to_vec3(source.entry.diffuse);
        Material material = diffuse_material(clamped(given));
        if (!(clamped(given) == given)) {
            approximate(source, "a diffuse reflectance (Kd) lies outside 0 to 1 and is limited");
        }
        if (source.entry.diffuse_texname.empty()) {
            return material;
        }
        const int image = load(source, source.entry.diffuse_texname, "map_Kd", {});
        if (image < 0) {
            return diffuse_material({0.5f, 0.5f, 0.5f});
        }
        // Many exporters leave Kd black beside a texture, which then alone gives the colour.
        material.reflectance.texture = add_texture(scene_, plain_texture(image));
        if (is_zero(material.reflectance.value)) {
            material.reflectance.value = {1, 1, 1};
        }
        return material;
    }

    // Dissolves the material by `d` and `map_d`.
    uint add_mask(const MaterialSource& source, uint material) {
        const float d = source.entry.dissolve;
        Parameter opacity = parameter_of(std::clamp(d, 0.0f, 1.0f));
        if (!(d >= 0.0f && d <= 1.0f)) {
            approximate(source, "an opacity (d) lies outside 0 to 1 and is limited");
        }
        if (!source.entry.alpha_texname.empty()) {
            const int image =
                load(source, source.entry.alpha_texname, "map_d", {.gamma = 1.0f, .is_number = true});
            opacity.texture = image < 0 ? -1 : add_texture(scene_, plain_texture(image));
        }
        if (opacity.value.x == 1.0f && opacity.texture < 0) {
            return material;
        }
        Material mask = mask_material(opacity, material);
        mask.emission = scene_.materials[material].emission;
        scene_.materials.push_back(mask);
        return static_cast<uint>(scene_.materials.size() - 1);
    }

    Scene& scene_;
    NoteSink& notes_;
    TextureLoader textures_;
};

std::vector<uint> make_materials(Scene& scene, const ObjFile& obj, NoteSink& notes) {
    const std::vector<MaterialLibrary> libraries = read_libraries(obj, notes);
    ObjMaterials materials(scene, notes);
    std::vector<uint> indices;
    for (const std::string& name : obj.materials) {
        const MaterialLibrary* found = nullptr;
        for (const MaterialLibrary& library : libraries) {
            found = found == nullptr && library.names.contains(name) ? &library : found;
        }
        if (found == nullptr && !name.empty()) {
            notes.approximation(obj.mesh.source, find_line(obj.text, "usemtl", name),
                                "material '" + name + "' is not defined; it is grey");
        }
        if (found == nullptr) {
            indices.push_back(materials.add_grey());
            continue;
        }
        const auto& entry = found->materials[static_cast<std::size_t>(found->names.at(name))];
        indices.push_back(materials.add({*found, entry, find_line(found->text, "newmtl", entry.name)}));
    }
    return indices;
}

}  // namespace

ObjFile read_obj(const std::filesystem::path& file, NoteSink& notes, bool keep_text) {
    ObjFile obj;
    obj.mesh.source = file;
    obj.text = read_file_text(file);
    for_each_line(obj.text, [&](int, std::string_view line) {
        if (starts_with_word(line, "mtllib")) {
            obj.libraries.push_back(trimmed(line.substr(line.find("mtllib") + 6)));
        }
        return true;
    });
    ObjBuilder builder(obj);
    TextBuffer buffer(obj.text);
    std::istream stream(&buffer);
    std::string warning;
    std::string error;
    if (!tinyobj::LoadObjWithCallback(stream, make_callbacks(), &builder, nullptr, &warning, &error)) {
        throw Error(ErrorKind::file, file.string() + ": not a valid OBJ file: " + trimmed(error));
    }
    builder.finish();
    if (builder.short_faces() > 0) {
        notes.approximation(
            file, 0,
            std::to_string(builder.short_faces()) + " faces with fewer than three corners are left out");
    }
    if (!keep_text) {
        obj.text = {};
    }
    return obj;
}

Scene load_obj_scene(const std::filesystem::path& file, const LoadOptions& options) {
    Scene scene;
    scene.source = file;
    scene.name = file.stem().string();
    NoteSink notes(scene.notes, options.strict);
    {
        const ObjFile obj = read_obj(file, notes, true);
        const std::vector<uint> materials = make_materials(scene, obj, notes);
        append_mesh(scene, obj.mesh, {.to_world = {}, .materials = materials}, notes);
    }
    add_default_view(scene, notes);
    return scene;
}

}  // namespace nearlight::core
