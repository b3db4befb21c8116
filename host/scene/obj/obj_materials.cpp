// SPDX-License-Identifier: Apache-2.0
#include "host/scene/obj/obj_materials.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "host/scene/layered_materials.h"
#include "host/scene/material_model.h"
#include "host/scene/model_scene.h"
#include "host/scene/obj/mtl_entry.h"
#include "host/scene/obj/mtl_file.h"
#include "host/scene/obj/mtl_textures.h"
#include "host/scene/obj/obj_images.h"
#include "host/scene/scene_names.h"
#include "host/scene/texture.h"
#include "host/scene/texture_loader.h"

namespace nearlight::core {
namespace {

using namespace mtl;

// A material library's entry, and where notes of it point.
struct MaterialSource {
    const MaterialLibrary& library;
    const tinyobj::material_t& entry;
    TextLine begin;
    const Mesh& mesh;  // the file's, and the group of the triangles that have the material
    uint group;
};

/// Whether the texture of a bump map is a map of normals, as which Blender and others write them: its mean
/// points out of the surface.
bool is_map_of_normals(Vec3 mean) {
    const auto is_middle = [](float value) { return std::abs(value - 0.5f) < 0.15f; };
    return is_middle(mean.x) && is_middle(mean.y) && mean.z > 0.7f;
}

class ObjMaterials {
  public:
    /// With colours of vertices, these multiply Kd.
    ObjMaterials(Scene& scene, NoteSink& notes, bool has_colors)
        : scene_(scene), notes_(notes), textures_(scene, notes), has_colors_(has_colors) {}

    /// Images that textures of materials will probably show.
    void expect(std::vector<ImageSource> images) { textures_.expect(std::move(images)); }

    // The index of the material.
    uint add(const MaterialSource& source) {
        warn_of_what_is_left_out(source);
        const Look look = look_of(source.entry, source.library.is_blenders());
        const uint made =
            look == Look::glass ? add_glass(source) : dissolve(source, add_opaque(source, look));
        scene_.materials[made].emission = emission(source);
        return made;
    }

  private:
    void approximate(const MaterialSource& source, const std::string& what) {
        notes_.approximation(source.library.file, source.begin.number, what);
    }

    /// Whether the entry has a line that begins with this word, and has this value somewhere.
    static bool says(const MaterialSource& source, const char* word, const char* value = "") {
        return find_in_block(source.library.text, source.begin, "newmtl", word, value) > 0;
    }

    /// Whether the entry gives a colour to the light that the surface reflects or emits.
    static bool says_color(const MaterialSource& source) {
        return std::ranges::any_of(std::array{"Kd", "map_Kd", "Ks", "map_Ks", "Ke", "map_Ke"},
                                   [&](const char* word) { return says(source, word); });
    }

    void warn_of_what_is_left_out(const MaterialSource& source) {
        note_unknown_statements(source.library, source.begin, notes_);
        if (!source.entry.displacement_texname.empty()) {
            approximate(source, "displacement maps of OBJ materials are left out");
        }
        if (source.entry.sheen > 0 || source.entry.clearcoat_thickness > 0 || source.entry.anisotropy > 0) {
            approximate(source,
                        "sheen, clear coat and anisotropy (Ps, Pc, aniso) of OBJ materials are left out");
        }
        if (has_highlight(source.entry) && !source.entry.specular_highlight_texname.empty()) {
            approximate(source, "textures of the exponent (map_Ns) of OBJ materials are left out");
        }
    }

    uint add(const Material& material) {
        scene_.materials.push_back(material);
        return static_cast<uint>(scene_.materials.size() - 1);
    }

    uint add_opaque(const MaterialSource& source, Look look) {
        return look == Look::mirror ? add_mirror(source) : add_two_sided(scene_, one_sided(source, look));
    }

    Material one_sided(const MaterialSource& source, Look look) {
        switch (look) {
            case Look::principled:
                return principled(source);
            case Look::blenders_principled:
                return blenders_principled(source);
            case Look::plastic:
                return plastic(source);
            default:
                return diffuse(source);
        }
    }

    /// A body where the model refracts and the surface has no border, otherwise a pane. Tf tints it.
    uint add_glass(const MaterialSource& source) {
        const bool is_body = source.entry.illum != 4 && is_closed(source.mesh, source.group);
        const double index = index_of(source.entry);
        Material glass = is_body ? dielectric_material(index) : thin_dielectric_material(index);
        const Vec3 tint = hue(max(to_vec3(source.entry.transmittance), {0, 0, 0}));
        // Light that goes through a body passes its surface twice.
        glass.transmission =
            parameter_of(is_body ? Vec3{std::sqrt(tint.x), std::sqrt(tint.y), std::sqrt(tint.z)} : tint);
        if (!is_body) {
            approximate(source, "a transparent material is rendered as a thin pane of glass");
        }
        return add(glass);
    }

    /// Mirrors Ks of the light, and scatters Kd, as illum 3 says.
    uint add_mirror(const MaterialSource& source) {
        if (source.entry.illum == 5) {
            approximate(source, "a reflecting material (illum 5) mirrors the same at all angles");
        }
        if (!source.entry.specular_texname.empty()) {
            approximate(source, "textures of the colour (map_Ks) of mirrors (illum 3 and 5) are left out");
        }
        const Vec3 mirrored = clamped(to_vec3(source.entry.specular));
        const float weight = max_component(mirrored);
        Material base = diffuse(source);
        const bool has_base = !is_zero(base.reflectance.value);
        if (weight <= 0.0f) {
            return add_two_sided(scene_, base);
        }
        if (weight >= 1.0f || !has_base) {
            return add_two_sided(scene_, conductor_material({0, 0, 0}, {1, 1, 1}, mirrored));
        }
        const Vec3 scattered = base.reflectance.value / (1.0f - weight);
        if (!(clamped(scattered) == scattered)) {
            approximate(source, "Kd and Ks reflect more than all light together; Kd is reduced");
        }
        base.reflectance.value = clamped(scattered);
        const uint first = add_two_sided(scene_, base);
        const uint second =
            add_two_sided(scene_, conductor_material({0, 0, 0}, {1, 1, 1}, mirrored / weight));
        return add(blend_material(parameter_of(weight), first, second));
    }

    // The number, times a texture if the file names one.
    Parameter number_of(const MaterialSource& source, float number, const TextureSource& texture) {
        Parameter parameter = parameter_of(std::clamp(number, 0.0f, 1.0f));
        parameter.texture = load(source, texture, {.gamma = 1.0f, .is_number = true});
        if (parameter.texture >= 0 && number <= 0.0f) {
            parameter.value = {1, 1, 1};
        }
        return parameter;
    }

    Material layered(const tinyobj::material_t& entry, const Parameter& roughness) {
        Material material = layered_.of(
            scene_,
            {.eta = index_of(entry), .roughness = static_cast<double>(min_value(scene_, roughness).x)});
        material.roughness = roughness;
        return material;
    }

    Material principled(const MaterialSource& source) {
        const tinyobj::material_t& entry = source.entry;
        const Parameter roughness =
            number_of(source, entry.roughness, {entry.roughness_texname, entry.roughness_texopt, "map_Pr"});
        Material material = layered(entry, roughness);
        material.reflectance = diffuse(source).reflectance;
        material.metallic =
            number_of(source, entry.metallic, {entry.metallic_texname, entry.metallic_texopt, "map_Pm"});
        return material;
    }

    /// What Blender's exporter writes of its principled material in the words of an older model.
    Material blenders_principled(const MaterialSource& source) {
        Material material = layered(
            source.entry,
            parameter_of(blenders_roughness(source.entry.shininess, source.library.blenders_exponent)));
        material.reflectance = diffuse(source).reflectance;
        material.metallic = parameter_of(blenders_metalness(source.entry));
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
        material.specular.texture =
            load(source, {source.entry.specular_texname, source.entry.specular_texopt, "map_Ks"}, {});
        if (material.specular.texture < 0 && !says(source, "Ks")) {
            material.specular = parameter_of(0.5f);  // the image cannot be read
        }
        return material;
    }

    Material diffuse(const MaterialSource& source) {
        const Vec3 given = to_vec3(source.entry.diffuse);
        Material material = diffuse_material(clamped(given));
        if (!(clamped(given) == given)) {
            approximate(source, "a diffuse reflectance (Kd) lies outside 0 to 1 and is limited");
        }
        if (!says_color(source) && has_colors_) {
            material = diffuse_material({1, 1, 1});  // those of the vertices multiply it
        } else if (!says_color(source)) {
            approximate(source, "a material without any colour (Kd, Ks, Ke) is grey");
            material = diffuse_material({0.5f, 0.5f, 0.5f});
        }
        if (!source.entry.diffuse_texname.empty()) {
            const int texture =
                load(source, {source.entry.diffuse_texname, source.entry.diffuse_texopt, "map_Kd"}, {});
            if (texture < 0) {
                material = diffuse_material({0.5f, 0.5f, 0.5f});
            } else {
                material.reflectance.texture = texture;
                // Many exporters leave Kd black or out beside a texture, which then alone gives the colour.
                if (is_zero(material.reflectance.value) || !says(source, "Kd")) {
                    material.reflectance.value = {1, 1, 1};
                }
            }
        }
        if (has_colors_) {
            material.reflectance = times_vertex_color(material.reflectance);
        }
        return material;
    }

    Parameter times_vertex_color(Parameter color) {
        if (color.texture >= 0) {
            scene_.textures[static_cast<std::size_t>(color.texture)].parameters.flags |=
                NEARLIGHT_TEXTURE_TIMES_COLOR;
            return color;
        }
        if (vertex_color_ < 0) {
            vertex_color_ = add_texture(scene_, vertex_color_texture());
        }
        return {color.value, vertex_color_};
    }

    Parameter emission(const MaterialSource& source) {
        const tinyobj::material_t& entry = source.entry;
        Parameter emission = parameter_of(max(to_vec3(entry.emission), {0, 0, 0}));
        emission.texture = load(source, {entry.emissive_texname, entry.emissive_texopt, "map_Ke"}, {});
        if (emission.texture >= 0 && is_zero(emission.value)) {
            emission.value = {1, 1, 1};
        }
        return emission;
    }

    uint add_normal_map(const MaterialSource& source, uint child) {
        const tinyobj::material_t& entry = source.entry;
        if (!entry.normal_texname.empty()) {
            const int map = load_normals(source, {entry.normal_texname, entry.normal_texopt, "norm"});
            return map < 0 ? child : add(normal_map_material(textured(map), child));
        }
        if (entry.bump_texname.empty()) {
            return child;
        }
        const TextureSource bump{entry.bump_texname, entry.bump_texopt, "map_Bump"};
        const int heights = load(source, bump, {.gamma = 1.0f});
        if (heights < 0) {
            return child;
        }
        if (!is_map_of_normals(mean_value(scene_, textured(heights)))) {
            approximate(source,
                        "bump maps of OBJ materials are left out, because their heights have no unit");
            return child;
        }
        return add(normal_map_material(textured(load_normals(source, bump)), child));
    }

    /// A map of normals, which -bm makes steeper or flatter.
    int load_normals(const MaterialSource& source, const TextureSource& texture) {
        const float steepness = texture.options.bump_multiplier;
        return load(source, texture,
                    {.gamma = 1.0f,
                     .is_signed = std::abs(steepness) > 1.0f,
                     .steepness_x = steepness,
                     .steepness_y = steepness});
    }

    // The opaque material with its map of normals, dissolved by `d` and `map_d`.
    uint dissolve(const MaterialSource& source, uint opaque) {
        return add_mask(source, add_normal_map(source, opaque));
    }

    uint add_mask(const MaterialSource& source, uint material) {
        float d = source.entry.dissolve;
        if (d == 0.0f && !says(source, "d")) {
            approximate(source,
                        "a transparency (Tr) of 1 counts as an opacity, because many programs write it so");
            d = 1.0f;
        }
        Parameter opacity = parameter_of(std::clamp(d, 0.0f, 1.0f));
        if (says(source, "d", "-halo")) {
            approximate(source, "the opacity (d -halo) counts for all directions");
        }
        if (!(d >= 0.0f && d <= 1.0f)) {
            approximate(source, "an opacity (d) lies outside 0 to 1 and is limited");
        }
        opacity.texture = opacity_map(source);
        if (opacity.value.x == 1.0f && opacity.texture < 0) {
            return material;
        }
        return add(mask_material(opacity, material));
    }

    /// The texture of map_d, or else of map_Tr, which tinyobjloader does not know. −1 if there is none.
    int opacity_map(const MaterialSource& source) {
        const tinyobj::material_t& entry = source.entry;
        const auto transparency = entry.unknown_parameter.find("map_Tr");
        if (!entry.alpha_texname.empty() || transparency == entry.unknown_parameter.end()) {
            return load(source, {entry.alpha_texname, entry.alpha_texopt, "map_d"},
                        {.gamma = 1.0f, .is_number = true, .prefers_alpha = true});
        }
        approximate(source,
                    "a texture of the transparency (map_Tr) counts as 1 minus its red; programs disagree");
        std::string name;
        tinyobj::texture_option_t options = entry.alpha_texopt;
        tinyobj::ParseTextureNameAndOption(&name, &options, transparency->second.c_str());
        return load(source, {name, options, "map_Tr"},
                    {.gamma = 1.0f, .is_number = true, .channel = 0, .is_inverse = true});
    }

    int load(const MaterialSource& source, const TextureSource& texture, const TexelRule& rule) {
        return textures_.load(source.library, source.begin, texture, rule);
    }

    Scene& scene_;
    NoteSink& notes_;
    MtlTextures textures_;
    std::map<Coat, Material> coats_;
    LayeredMaterials layered_;
    bool has_colors_;
    int vertex_color_ = -1;  // the texture that stands for colours of vertices
};

TextLine line_of(const std::unordered_map<std::string, TextLine>& lines, const std::string& value) {
    const auto found = lines.find(value);
    return found == lines.end() ? TextLine{} : found->second;
}

}  // namespace

std::vector<uint> add_obj_materials(Scene& scene, const ObjFile& obj, NoteSink& notes) {
    const std::vector<MaterialLibrary> libraries = read_libraries(obj, notes);
    std::vector<std::string> names;
    std::vector<const MaterialLibrary*> owners;  // of each material's entry; null if nothing defines it
    for (const std::string& name : obj.materials) {
        names.push_back(known_name(libraries, name));
        owners.push_back(find_library(libraries, names.back()));
    }
    ObjMaterials materials(scene, notes, !obj.mesh.colors.empty());
    materials.expect(images_of(names, owners));
    const auto uses = lines_by_value(obj.text, "usemtl");
    std::vector<uint> indices;
    for (std::size_t i = 0; i < owners.size(); ++i) {
        const std::string& name = names[i];
        if (owners[i] == nullptr && !name.empty()) {
            notes.approximation(obj.mesh.source, line_of(uses, name).number,
                                "material '" + name + "' is not defined; it is grey");
        }
        if (owners[i] == nullptr) {
            indices.push_back(add_plain_surface(scene, !obj.mesh.colors.empty()));
        } else {
            const tinyobj::material_t& entry = owners[i]->entry(name);
            indices.push_back(materials.add(
                {*owners[i], entry, line_of(owners[i]->lines, entry.name), obj.mesh, static_cast<uint>(i)}));
        }
        name_material(scene, indices.back(), name);
    }
    return indices;
}

}  // namespace nearlight::core
