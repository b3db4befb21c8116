// SPDX-License-Identifier: Apache-2.0
#include "host/scene/obj_materials.h"

#include <tiny_obj_loader.h>

#include <cmath>
#include <istream>
#include <map>

#include "host/scene/file_text.h"
#include "host/scene/material_model.h"
#include "host/scene/obj_text.h"
#include "host/scene/scene_names.h"
#include "host/scene/texture_loader.h"
#include "nearlight/error.h"

namespace nearlight::core {
namespace {

// A material library, with its text for line numbers.
struct MaterialLibrary {
    std::filesystem::path file;
    std::string text;
    std::unordered_map<std::string, TextLine> lines;  ///< where materials begin
    std::map<std::string, int> names;
    std::vector<tinyobj::material_t> materials;
};

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

std::vector<MaterialLibrary> read_libraries(const ObjFile& obj, NoteSink& notes) {
    std::vector<MaterialLibrary> libraries;
    for (const auto& [line, name] : obj.libraries) {
        MaterialLibrary library;
        library.file = resolve_path(obj.mesh.source, name);
        try {
            library.text = read_file_text(library.file);
        } catch (const Error&) {
            notes.approximation(obj.mesh.source, line,
                                "material library '" + name + "' cannot be read; its materials are grey");
            continue;
        }
        TextBuffer buffer(library.text);
        std::istream stream(&buffer);
        std::string warning;
        std::string error;
        tinyobj::LoadMtl(&library.names, &library.materials, &stream, &warning, &error);
        restore_names(library);
        library.lines = lines_by_value(library.text, "newmtl");
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

// Whether the entry has the extension for physically based rendering.
bool is_physically_based(const tinyobj::material_t& source) {
    return source.roughness > 0 || source.metallic > 0 || !source.roughness_texname.empty() ||
           !source.metallic_texname.empty();
}

// The illumination model 1 has no highlights, whatever Ks says.
bool has_highlight(const tinyobj::material_t& source) {
    return source.illum != 1 && !is_zero(clamped(to_vec3(source.specular)));
}

// The microfacets of Beckmann's distribution that are as rough as a highlight with the exponent Ns [Walter et
// al., Microfacet Models for Refraction through Rough Surfaces, 2007].
double alpha_of_exponent(double exponent) {
    return std::sqrt(2.0 / (std::min(std::max(0.0, exponent), 1e6) + 2.0));
}

// The index of refraction, Ni; files that say 1 or nothing mean that of glass and plastics.
double index_of(const tinyobj::material_t& source) {
    return source.ior > 1.001f ? static_cast<double>(source.ior) : kUsualIndex;
}

// A material library's entry, and where notes of it point.
struct MaterialSource {
    const MaterialLibrary& library;
    const tinyobj::material_t& entry;
    TextLine begin;
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
            Material pane = thin_dielectric_material(index_of(source.entry));
            pane.emission = emission;
            scene_.materials.push_back(pane);
            return static_cast<uint>(scene_.materials.size() - 1);
        }
        Material side = opaque(source);
        side.emission = emission;
        return add_mask(source, add_two_sided(scene_, side));
    }

    uint add_grey() { return add_two_sided(scene_, diffuse_material({0.5f, 0.5f, 0.5f})); }

  private:
    void approximate(const MaterialSource& source, const std::string& what) {
        notes_.approximation(source.library.file, source.begin.number, what);
    }

    void warn_of_what_is_left_out(const MaterialSource& source) {
        if (!source.entry.bump_texname.empty() || !source.entry.displacement_texname.empty() ||
            !source.entry.normal_texname.empty()) {
            approximate(source, "bump, displacement and normal maps of OBJ materials are left out");
        }
        if (source.entry.sheen > 0 || source.entry.clearcoat_thickness > 0 || source.entry.anisotropy > 0) {
            approximate(source,
                        "sheen, clear coat and anisotropy (Ps, Pc, aniso) of OBJ materials are left out");
        }
        if (has_highlight(source.entry) && !source.entry.specular_highlight_texname.empty()) {
            approximate(source, "textures of the exponent (map_Ns) of OBJ materials are left out");
        }
    }

    Material opaque(const MaterialSource& source) {
        if (is_physically_based(source.entry)) {
            return principled(source);
        }
        if (is_mirror(source.entry)) {
            return mirror(source);
        }
        return has_highlight(source.entry) ? plastic(source) : diffuse(source);
    }

    // The share `number`, times a texture if the file names one.
    Parameter share(const MaterialSource& source, float number, const std::string& texture,
                    const char* keyword) {
        Parameter parameter = parameter_of(std::clamp(number, 0.0f, 1.0f));
        if (!texture.empty()) {
            const int image = load(source, texture, keyword, {.gamma = 1.0f, .is_number = true});
            parameter.texture = image < 0 ? -1 : add_texture(scene_, plain_texture(image));
            if (parameter.texture >= 0 && number <= 0.0f) {
                parameter.value = {1, 1, 1};
            }
        }
        return parameter;
    }

    Material principled(const MaterialSource& source) {
        Material material = principled_material(scene_, index_of(source.entry));
        material.reflectance = diffuse(source).reflectance;
        material.roughness = share(source, source.entry.roughness, source.entry.roughness_texname, "map_Pr");
        material.metallic = share(source, source.entry.metallic, source.entry.metallic_texname, "map_Pm");
        return material;
    }

    // A base of Kd under a rough coat, whose reflections Ks tints.
    Material plastic(const MaterialSource& source) {
        const Coat coat{.eta = index_of(source.entry),
                        .alpha = alpha_of_exponent(static_cast<double>(source.entry.shininess)),
                        .beckmann = true};
        const auto [known, is_new] = coats_.try_emplace(coat);
        if (is_new) {
            known->second = plastic_material(scene_, coat);
        }
        Material material = known->second;
        material.reflectance = diffuse(source).reflectance;
        material.specular = parameter_of(clamped(to_vec3(source.entry.specular)));
        if (!source.entry.specular_texname.empty()) {
            const int image = load(source, source.entry.specular_texname, "map_Ks", {});
            material.specular.texture = image < 0 ? -1 : add_texture(scene_, plain_texture(image));
        }
        return material;
    }

    int load(const MaterialSource& source, const std::string& name, const char* keyword,
             const TexelRule& rule) {
        return textures_.load(resolve_path(source.library.file, name), rule, source.library.file,
                              find_in_block(source.library.text, source.begin, "newmtl", keyword, name));
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
    std::map<Coat, Material> coats_;
};

TextLine line_of(const std::unordered_map<std::string, TextLine>& lines, const std::string& value) {
    const auto found = lines.find(value);
    return found == lines.end() ? TextLine{} : found->second;
}

}  // namespace

std::vector<uint> add_obj_materials(Scene& scene, const ObjFile& obj, NoteSink& notes) {
    const std::vector<MaterialLibrary> libraries = read_libraries(obj, notes);
    ObjMaterials materials(scene, notes);
    const auto uses = lines_by_value(obj.text, "usemtl");
    std::vector<uint> indices;
    for (const std::string& name : obj.materials) {
        const MaterialLibrary* found = nullptr;
        for (const MaterialLibrary& library : libraries) {
            found = found == nullptr && library.names.contains(name) ? &library : found;
        }
        if (found == nullptr && !name.empty()) {
            notes.approximation(obj.mesh.source, line_of(uses, name).number,
                                "material '" + name + "' is not defined; it is grey");
        }
        if (found == nullptr) {
            indices.push_back(materials.add_grey());
        } else {
            const auto& entry = found->materials[static_cast<std::size_t>(found->names.at(name))];
            indices.push_back(materials.add({*found, entry, line_of(found->lines, entry.name)}));
        }
        name_material(scene, indices.back(), name);
    }
    return indices;
}

}  // namespace nearlight::core
