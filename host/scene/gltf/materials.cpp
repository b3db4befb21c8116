// SPDX-License-Identifier: Apache-2.0
#include "host/scene/gltf/materials.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <tuple>
#include <utility>

#include "host/scene/gltf/transmission.h"
#include "host/scene/material_model.h"
#include "host/scene/scene_names.h"
#include "host/scene/shining_backs.h"
#include "host/scene/texture.h"
#include "host/scene/transmission_curve.h"

namespace nearlight::core::gltf {
namespace {

/// The roughness that the principled model's clearcoat can have is that of α from 0.001 to 0.1.
float clearcoat_gloss(double roughness) {
    return static_cast<float>(std::clamp((0.1 - roughness * roughness) / (0.1 - 0.001), 0.0, 1.0));
}

bool has_emission(const tinygltf::Material& source) {
    return std::ranges::any_of(source.emissiveFactor, [](double factor) { return factor > 0; });
}

/// The texture of the base colour and of the alpha of surfaces that have holes.
tinygltf::TextureInfo base_texture_of(const tinygltf::Material& source) {
    if (uses_specular_glossiness(source)) {
        return texture_of(source.extensions, "KHR_materials_pbrSpecularGlossiness", "diffuseTexture");
    }
    const tinygltf::PbrMetallicRoughness& pbr = source.pbrMetallicRoughness;
    const std::vector<double>& factor = pbr.baseColorFactor;
    const bool is_black = factor.size() >= 3 && factor[0] <= 0 && factor[1] <= 0 && factor[2] <= 0;
    return is_black && !has_opacity(source) ? tinygltf::TextureInfo{} : pbr.baseColorTexture;
}

/// The texture of metalness and roughness, or of what is converted to them.
tinygltf::TextureInfo reflection_texture_of(const tinygltf::Material& source) {
    if (uses_specular_glossiness(source)) {
        return texture_of(source.extensions, "KHR_materials_pbrSpecularGlossiness",
                          "specularGlossinessTexture");
    }
    const tinygltf::PbrMetallicRoughness& pbr = source.pbrMetallicRoughness;
    return pbr.metallicFactor > 0 || pbr.roughnessFactor > 0 ? pbr.metallicRoughnessTexture
                                                             : tinygltf::TextureInfo{};
}

/// The textures that matter most to a material first, without those that a factor of 0 or another texture
/// keeps out of sight.
std::vector<tinygltf::TextureInfo> textures_of(const tinygltf::Material& source) {
    std::vector<tinygltf::TextureInfo> infos{plain_info(source.normalTexture), base_texture_of(source)};
    if (has_emission(source)) {
        infos.push_back(source.emissiveTexture);
    }
    infos.push_back(reflection_texture_of(source));
    for (const auto& [extension, factor, key] :
         {std::tuple{"KHR_materials_transmission", "transmissionFactor", "transmissionTexture"},
          {"KHR_materials_diffuse_transmission", "diffuseTransmissionFactor", "diffuseTransmissionTexture"},
          {"KHR_materials_diffuse_transmission", "diffuseTransmissionFactor",
           "diffuseTransmissionColorTexture"},
          {"KHR_materials_clearcoat", "clearcoatFactor", "clearcoatTexture"}}) {
        if (number_of(source.extensions, extension, factor, 0) > 0) {
            infos.push_back(texture_of(source.extensions, extension, key));
        }
    }
    return infos;
}

}  // namespace

void MaterialMaker::approximate(const std::string& what) {
    notes_.approximation(file_.path, 0, what);
}

uint MaterialMaker::add(const Material& material) {
    scene_.materials.push_back(material);
    return static_cast<uint>(scene_.materials.size() - 1);
}

/// A white base below the layers of the surface.
Material MaterialMaker::layered_base(const SurfaceModel& surface) {
    return layered_.of(scene_, {.eta = surface.index,
                                .roughness = static_cast<double>(min_value(scene_, surface.roughness).x),
                                .clearcoat = static_cast<double>(mean_value(scene_, surface.clearcoat).x),
                                .sheen = static_cast<double>(mean_value(scene_, surface.sheen).x)});
}

/// A base with reflections, or metal, or a texture's choice of both, on both sides.
uint MaterialMaker::add_opaque(const SurfaceModel& surface) {
    if (surface.is_unlit) {
        return add(diffuse_material({0, 0, 0}));
    }
    if (surface.has_metal_color) {
        return add_mixture(surface);
    }
    if (surface.is_diffuse()) {
        Material base = diffuse_material({1, 1, 1});
        base.reflectance = surface.color;
        return add_two_sided(scene_, base);
    }
    Material material = layered_base(surface);
    material.reflectance = surface.color;
    material.metallic = surface.metallic;
    material.roughness = surface.stretched_roughness;
    material.clearcoat = surface.clearcoat;
    material.clearcoat_gloss = parameter_of(clearcoat_gloss(surface.clearcoat_roughness));
    material.sheen = surface.sheen;
    if (surface.anisotropic > 0.0f) {
        material.anisotropic = parameter_of(surface.anisotropic);
        material.flags |= NEARLIGHT_MATERIAL_TANGENT;
    }
    return add_two_sided(scene_, material);
}

/// Metal with a colour of its own beside the rest of a surface.
uint MaterialMaker::add_mixture(const SurfaceModel& surface) {
    SurfaceModel metal = surface;
    metal.has_metal_color = false;
    metal.metallic = parameter_of(1.0f);
    metal.color = surface.metal_color;
    SurfaceModel rest = surface;
    rest.has_metal_color = false;
    rest.metallic = parameter_of(0.0f);
    const uint first = add_opaque(rest);
    return add(blend_material(surface.metallic, first, add_opaque(metal)));
}

/// A sheet through which all light diffuses that the layers of the surface leave to it.
uint MaterialMaker::add_sheet(const SurfaceModel& surface) {
    Material sheet = principled_material(scene_, kUsualIndex);
    sheet.flags |= NEARLIGHT_MATERIAL_THIN;
    sheet.reflectance = surface.passed_color;
    if (!surface.is_diffuse()) {
        approximate("KHR_materials_diffuse_transmission: reflections fade as more light diffuses through");
        const std::size_t row = std::size_t{layered_base(surface).curve} * NEARLIGHT_CURVE_SIZE;
        const float root =
            mean_transmission(std::span(scene_.transmission_curves).subspan(row, NEARLIGHT_CURVE_SIZE));
        sheet.reflectance.value *= root * root;
    }
    return add(sheet);
}

/// A pane whose faces scatter what they reflect and let through.
uint MaterialMaker::add_rough_pane(const SurfaceModel& surface, double index) {
    Material pane = principled_material(scene_, index);
    pane.flags |= NEARLIGHT_MATERIAL_THIN;
    pane.reflectance = surface.color;
    pane.roughness = surface.roughness;
    pane.spec_trans = parameter_of(1.0f);
    pane.transmission = parameter_of(0.0f);
    return add(pane);
}

uint MaterialMaker::add_glass(const SurfaceModel& surface) {
    const double index = surface.refraction_index;
    const bool is_rough = surface.roughness.value.x > 0.0f;
    if (surface.is_thin && is_rough) {
        return add_rough_pane(surface, index);
    }
    Material glass = surface.is_thin ? thin_dielectric_material(index) : dielectric_material(index);
    glass.transmission = surface.color;
    glass.transmission.value = glass.transmission.value * surface.absorption;
    glass.roughness = surface.body_alpha;
    return add(glass);
}

/// A normal map whose directions are those of the mesh's tangents or else of its texture coordinates after
/// their transform, as glTF has it. The scene's are those of the coordinates before it.
uint MaterialMaker::add_normal_map(const tinygltf::Material& source, const SurfaceContext& context,
                                   const MaterialUse& use, uint child) {
    const tinygltf::TextureInfo info = plain_info(source.normalTexture);
    const TextureAxes axes = use.has_tangents ? TextureAxes{} : texture_axes(info);
    if (axes.are_oblique()) {
        approximate(
            "KHR_texture_transform turns normal maps as on surfaces whose texture coordinates keep angles");
    }
    const auto scale = static_cast<float>(source.normalTexture.scale);
    const float scale_y = use.is_mirrored ? -scale : scale;
    const Parameter normals =
        textures_.textured_by(info, {1, 1, 1},
                              {.gamma = 1.0f,
                               .is_signed = std::abs(scale) > 1.0f || axes.are_oblique(),
                               .steepness_x = scale * axes.u[0],
                               .steepness_y = scale_y * axes.v[1],
                               .x_of_y = scale * axes.v[0],
                               .y_of_x = scale_y * axes.u[1]},
                              context.sets);
    return normals.texture < 0 ? child : add(normal_map_material(normals, child));
}

/// Notes what a material may not say, and what becomes of it.
void MaterialMaker::note_odd_values(const tinygltf::Material& source) {
    const auto is_part = [](double factor) { return factor >= 0.0 && factor <= 1.0; };
    const tinygltf::PbrMetallicRoughness& pbr = source.pbrMetallicRoughness;
    if (!std::ranges::all_of(pbr.baseColorFactor, is_part) || !is_part(pbr.metallicFactor) ||
        !is_part(pbr.roughnessFactor)) {
        approximate("material '" + source.name +
                    "' has factors that are not between 0 and 1, and are limited");
    }
    for (const auto& [extension, key] : {std::pair{"KHR_materials_clearcoat", "clearcoatFactor"},
                                         {"KHR_materials_clearcoat", "clearcoatRoughnessFactor"},
                                         {"KHR_materials_transmission", "transmissionFactor"},
                                         {"KHR_materials_diffuse_transmission", "diffuseTransmissionFactor"},
                                         {"KHR_materials_pbrSpecularGlossiness", "glossinessFactor"},
                                         {"KHR_materials_anisotropy", "anisotropyStrength"},
                                         {"KHR_materials_specular", "specularFactor"}}) {
        if (!is_part(number_of(source.extensions, extension, key, 0))) {
            approximate("material '" + source.name + "' has a " + key +
                        " that is not between 0 and 1, and is limited");
        }
    }
    for (const auto& [extension, key, count] :
         {std::tuple{"KHR_materials_diffuse_transmission", "diffuseTransmissionColorFactor", 3u},
          {"KHR_materials_pbrSpecularGlossiness", "diffuseFactor", 4u},
          {"KHR_materials_pbrSpecularGlossiness", "specularFactor", 3u},
          {"KHR_materials_sheen", "sheenColorFactor", 3u}}) {
        if (!std::ranges::all_of(numbers_of(source.extensions, extension, key, count), is_part)) {
            approximate("material '" + source.name + "' has a " + key +
                        " that is not between 0 and 1, and is limited");
        }
    }
    const double index = number_of(source.extensions, "KHR_materials_ior", "ior", kUsualIndex);
    if (index != 0 && !(index >= 1)) {
        approximate("material '" + source.name + "' has an index (ior) below 1");
    }
    if (number_of(source.extensions, "KHR_materials_emissive_strength", "emissiveStrength", 1) < 0 ||
        std::ranges::any_of(source.emissiveFactor, [](double factor) { return factor < 0; })) {
        approximate("material '" + source.name + "' has an emission below 0, which counts as 0");
    }
    if (source.alphaMode != "OPAQUE" && source.alphaMode != "MASK" && source.alphaMode != "BLEND") {
        approximate("material '" + source.name + "' has the unknown alphaMode '" + source.alphaMode +
                    "', and is opaque");
    }
}

/// What is opaque, what lets light through, and the blends between them.
uint MaterialMaker::add_surface(const SurfaceModel& surface) {
    if (surface.is_glass()) {
        return add_glass(surface);
    }
    const uint opaque = add_opaque(surface);
    uint made = opaque;
    if (surface.diffuses_through()) {
        made = add(blend_material(surface.diffuse_transmission, made, add_sheet(surface)));
    }
    if (surface.transmits()) {
        made = add(blend_material(surface.transmission, made, add_glass(surface)));
    }
    if (made != opaque && surface.is_metal()) {  // metal lets nothing through
        made = add(blend_material(surface.metallic, made, opaque));
    }
    return made;
}

uint MaterialMaker::make(const tinygltf::Material& source, const MaterialUse& use) {
    note_odd_values(source);
    const SurfaceContext context{file_,          textures_,      notes_,   texture_sets(use.index),
                                 use.has_colors, use.has_alphas, use.scale};
    const SurfaceModel surface = read_surface(source, context);
    uint made = add_surface(surface);
    if (has_normal_map(use.index) && !surface.is_unlit) {
        made = add_normal_map(source, context, use, made);
    }
    for (const Parameter& opacity : {surface.opacity, surface.vertex_opacity}) {
        if (opacity.texture >= 0 || opacity.value.x < 1.0f) {
            made = add(mask_material(opacity, made));
        }
    }
    scene_.materials[made].emission = surface.emission;
    return made;
}

uint MaterialMaker::material(const MaterialUse& use) {
    const auto [entry, is_new] = made_.try_emplace(use);
    if (!is_new) {
        return entry->second;
    }
    if (use.index >= 0) {
        entry->second = make(source_of(use.index), use);
        name_material(
            scene_, entry->second,
            name_or_number(source_of(use.index).name, "material", static_cast<std::size_t>(use.index) + 1));
        return entry->second;
    }
    Material base = diffuse_material({0.5f, 0.5f, 0.5f});
    if (use.has_colors) {
        base.reflectance = textures_.vertex_color({1, 1, 1});
    } else {
        notes_.remark(file_.path, 0, "surfaces without a material are grey");
    }
    return entry->second = add_two_sided(scene_, base);
}

TextureSets MaterialMaker::texture_sets(int index) const {
    TextureSets sets;
    if (index < 0) {
        return sets;
    }
    for (const tinygltf::TextureInfo& info : textures_of(source_of(index))) {
        if (info.index >= 0) {
            const int set = texture_set_of(file_, info);
            if (sets.first < 0 || set == sets.first) {
                sets.first = set;
            } else if (sets.second < 0 || set == sets.second) {
                sets.second = set;
            } else {
                file_.fail("material '" + source_of(index).name +
                           "' uses more than two sets of texture coordinates; export it with two");
            }
        }
    }
    return sets;
}

bool MaterialMaker::has_normal_map(int index) const {
    return index >= 0 && source_of(index).normalTexture.index >= 0;
}

bool MaterialMaker::has_placed_normal_map(int index) const {
    return has_normal_map(index) &&
           source_of(index).normalTexture.extensions.contains("KHR_texture_transform");
}

bool MaterialMaker::is_transparent(int index) const {
    return index >= 0 && has_opacity(source_of(index));
}

bool MaterialMaker::shines_by_alpha(int index) const {
    return index >= 0 && gltf::shines_by_alpha(source_of(index));
}

bool MaterialMaker::absorbs_inside(int index) const {
    return index >= 0 && gltf::absorbs_inside(source_of(index));
}

bool MaterialMaker::emits_back(int index) const {
    if (index < 0 || !source_of(index).doubleSided) {
        return false;
    }
    const tinygltf::Material& source = source_of(index);
    return source.extensions.contains("KHR_materials_unlit") || has_emission(source);
}

std::vector<uint> MaterialMaker::shining_backs(const std::vector<uint>& fronts) {
    std::vector<uint> backs;
    for (const uint front : fronts) {
        const auto [entry, is_new] = backs_.try_emplace(front, front);
        if (is_new) {
            entry->second = add_back_material(scene_, front);
        }
        backs.push_back(entry->second);
    }
    return backs;
}

}  // namespace nearlight::core::gltf
