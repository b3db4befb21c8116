// SPDX-License-Identifier: Apache-2.0
#include "host/scene/gltf/surface_model.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "host/scene/gltf/factors.h"
#include "host/scene/gltf/reflections.h"
#include "host/scene/gltf/transmission.h"
#include "host/scene/material_model.h"

namespace nearlight::core::gltf {
namespace {

Vec3 to_vec3(const std::vector<double>& values, Vec3 fallback) {
    return values.size() < 3 ? fallback
                             : Vec3{static_cast<float>(values[0]), static_cast<float>(values[1]),
                                    static_cast<float>(values[2])};
}

/// The colour of the base, and its alpha.
struct Base {
    tinygltf::TextureInfo texture;
    Vec3 color{1, 1, 1};
    float alpha = 1;
};

Base base_of(const tinygltf::Material& source) {
    Base base;
    if (uses_specular_glossiness(source)) {
        base.texture = texture_of(source.extensions, kSpecularGlossiness, "diffuseTexture");
        const std::vector<double> factor =
            numbers_of(source.extensions, kSpecularGlossiness, "diffuseFactor", 4);
        base.color = clamped(to_vec3(factor, {1, 1, 1}));
        base.alpha = factor.empty() ? 1.0f : std::clamp(static_cast<float>(factor[3]), 0.0f, 1.0f);
        return base;
    }
    const tinygltf::PbrMetallicRoughness& pbr = source.pbrMetallicRoughness;
    base.texture = pbr.baseColorTexture;
    base.color = clamped(to_vec3(pbr.baseColorFactor, {1, 1, 1}));
    if (pbr.baseColorFactor.size() > 3) {
        base.alpha = std::clamp(static_cast<float>(pbr.baseColorFactor[3]), 0.0f, 1.0f);
    }
    return base;
}

/// The base's colour times those of the vertices, if there are any.
Parameter color_of_base(const Base& base, const SurfaceContext& context, const TexelRule& rule = {}) {
    const Parameter color =
        context.textures.textured_by(base.texture, base.color, rule, context.sets,
                                     context.has_colors ? NEARLIGHT_TEXTURE_TIMES_COLOR : 0u);
    return context.has_colors && color.texture < 0 ? context.textures.vertex_color(color.value) : color;
}

bool has_mask(const tinygltf::Material& source) {
    return source.alphaMode == "MASK" && source.alphaCutoff > 0;
}

/// The opacity that the base's factor leaves of masked and blended surfaces whose texture has an alpha of 1.
float opacity_of_factor(const tinygltf::Material& source, const Base& base) {
    if (has_mask(source)) {
        return base.alpha >= static_cast<float>(source.alphaCutoff) ? 1.0f : 0.0f;
    }
    return source.alphaMode == "BLEND" ? base.alpha : 1.0f;
}

/// The alpha above which a texture's texels count as opaque; 0 where all count as they are.
float texel_cutoff(const tinygltf::Material& source, const Base& base) {
    return has_mask(source) ? static_cast<float>(source.alphaCutoff) / base.alpha : 0.0f;
}

/// The colour times the opacity of masked and blended surfaces.
Parameter times_opacity(const tinygltf::Material& source, const Base& base, Vec3 color,
                        const SurfaceContext& context) {
    const Vec3 value = color * opacity_of_factor(source, base);
    if (!has_opacity(source)) {
        return parameter_of(value);
    }
    return context.textures.textured_by(base.texture, value, {.channel = 3}, context.sets, 0,
                                        texel_cutoff(source, base));
}

/// How the alpha of the base's image multiplies the light of the same image, because holes do not shine.
TexelRule shining_rule(const tinygltf::Material& source, const Base& base) {
    return has_opacity(source) ? TexelRule{.times_alpha = true, .alpha_cutoff = texel_cutoff(source, base)}
                               : TexelRule{};
}

/// The emission as a radiance, because exporters write a strength rather than nits.
Parameter emission_of(const tinygltf::Material& source, const Base& base, const SurfaceContext& context) {
    const double strength =
        number_of(source.extensions, "KHR_materials_emissive_strength", "emissiveStrength", 1);
    const Vec3 emission = static_cast<float>(std::max(strength, 0.0)) *
                          max(to_vec3(source.emissiveFactor, {0, 0, 0}), {0, 0, 0});
    if (!is_finite(emission)) {
        context.file.fail("material '" + source.name + "' emits light that is not finite");
    }
    if (is_zero(emission)) {
        return parameter_of(0.0f);
    }
    if (source.emissiveTexture.index < 0) {
        return times_opacity(source, base, emission, context);
    }
    const bool same = context.textures.show_same(source.emissiveTexture, base.texture);
    const TexelRule rule = shining_rule(source, base);
    if (rule.times_alpha && base.texture.index >= 0 && !same) {
        context.approximate(
            "emissive textures shine in the holes of base colour textures, because they show other images or "
            "other places of them");
    }
    return context.textures.textured_by(source.emissiveTexture, emission * opacity_of_factor(source, base),
                                        same ? rule : TexelRule{}, context.sets);
}

/// Lets the alpha of vertices make holes, which do not shine.
void read_vertex_alphas(const tinygltf::Material& source, const Base& base, const SurfaceContext& context,
                        SurfaceModel& surface) {
    if (!context.has_alphas || is_zero(surface.opacity.value)) {
        return;
    }
    if (has_mask(source) && surface.opacity.texture >= 0) {
        context.approximate("the alpha of vertex colours is left out where a texture makes a mask");
        return;
    }
    surface.vertex_opacity = context.textures.vertex_number(texel_cutoff(source, base));
    if (shines_by_alpha(source)) {
        return;  // the colours of the vertices have been multiplied by it
    }
    if (surface.is_unlit) {
        context.approximate(
            "KHR_materials_unlit: surfaces shine in the holes that the alpha of vertex colours makes");
    } else if (surface.emission.texture >= 0) {
        context.approximate("the alpha of vertex colours does not dim the light of textures");
    } else if (!is_zero(surface.emission.value)) {
        surface.emission.texture = surface.vertex_opacity.texture;
    }
}

/// KHR_materials_clearcoat and KHR_materials_sheen, as the principled model has them.
void read_layers(const tinygltf::Material& source, const SurfaceContext& context, SurfaceModel& surface) {
    constexpr const char* kCoat = "KHR_materials_clearcoat";
    constexpr const char* kSheen = "KHR_materials_sheen";
    surface.clearcoat = context.textures.textured_by(
        texture_of(source.extensions, kCoat, "clearcoatTexture"),
        grey(number_of(source.extensions, kCoat, "clearcoatFactor", 0)), {.channel = 0}, context.sets);
    surface.clearcoat_roughness =
        std::clamp(number_of(source.extensions, kCoat, "clearcoatRoughnessFactor", 0), 0.0, 1.0);
    if (source.extensions.contains(kCoat) && surface.clearcoat.value.x > 0.0f) {
        context.approximate(
            "KHR_materials_clearcoat: the coat reflects less at grazing angles, evenly smooth and without a "
            "normal map of its own");
    }
    const Vec3 sheen = clamped(color_of(source.extensions, kSheen, "sheenColorFactor", {0, 0, 0}));
    surface.sheen = parameter_of(luminance(sheen));
    if (source.extensions.contains(kSheen) && !is_zero(sheen)) {
        context.approximate("KHR_materials_sheen: the sheen is white, of one strength and roughness");
    }
}

/// Notes the extensions of materials that nothing here reads.
void remark_what_is_left_out(const tinygltf::Material& source, const SurfaceContext& context) {
    constexpr std::array<std::string_view, 11> kRead{"KHR_materials_anisotropy",
                                                     "KHR_materials_clearcoat",
                                                     "KHR_materials_diffuse_transmission",
                                                     "KHR_materials_emissive_strength",
                                                     "KHR_materials_ior",
                                                     kSpecularGlossiness,
                                                     "KHR_materials_sheen",
                                                     "KHR_materials_specular",
                                                     "KHR_materials_transmission",
                                                     "KHR_materials_unlit",
                                                     "KHR_materials_volume"};
    for (const auto& [name, value] : source.extensions) {
        const bool is_look = name.find("_materials_") != std::string::npos;
        if (is_look && std::ranges::find(kRead, name) == kRead.end()) {
            context.approximate(name + " is left out");
        }
    }
}

}  // namespace

bool uses_specular_glossiness(const tinygltf::Material& source) {
    return source.extensions.contains(kSpecularGlossiness) && !source.values.contains("baseColorTexture");
}

bool has_opacity(const tinygltf::Material& source) {
    return source.alphaMode == "BLEND" || has_mask(source);
}

bool shines_by_alpha(const tinygltf::Material& source) {
    return source.alphaMode == "BLEND" && source.extensions.contains("KHR_materials_unlit");
}

bool SurfaceModel::is_diffuse() const {
    const bool is_layered = clearcoat.value.x > 0.0f || sheen.value.x > 0.0f;
    return !is_layered && !is_metal() && !dielectric_reflects;
}

SurfaceModel read_surface(const tinygltf::Material& source, const SurfaceContext& context) {
    const Base base = base_of(source);
    SurfaceModel surface;
    surface.is_unlit = source.extensions.contains("KHR_materials_unlit");
    surface.opacity = times_opacity(source, base, {1, 1, 1}, context);
    remark_what_is_left_out(source, context);
    if (surface.is_unlit) {
        context.approximate("KHR_materials_unlit: surfaces shine with their colour, and light others");
        Base shining = base;
        shining.color = base.color * opacity_of_factor(source, base);
        surface.emission = color_of_base(shining, context, shining_rule(source, base));
        read_vertex_alphas(source, base, context, surface);
        return surface;
    }
    surface.color = color_of_base(base, context);
    surface.emission = emission_of(source, base, context);
    read_vertex_alphas(source, base, context, surface);
    read_reflections(source, context, surface);
    read_transmission(source, context, surface);
    read_anisotropy(source, context, surface);
    read_layers(source, context, surface);
    return surface;
}

}  // namespace nearlight::core::gltf
