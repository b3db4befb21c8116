// SPDX-License-Identifier: Apache-2.0
#include "host/scene/gltf/surface_model.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "host/scene/material_model.h"

namespace nearlight::core::gltf {
namespace {

constexpr const char* kSpecularGlossiness = "KHR_materials_pbrSpecularGlossiness";
constexpr const char* kVolume = "KHR_materials_volume";

/// The least index of the models, which stands for no reflections.
constexpr double kMinIndex = 1.001;

Vec3 clamped(Vec3 c) {
    return min(max(c, {0, 0, 0}), {1, 1, 1});
}

Vec3 grey(double number) {
    return Vec3{1, 1, 1} * static_cast<float>(std::clamp(number, 0.0, 1.0));
}

Vec3 to_vec3(const std::vector<double>& values, Vec3 fallback) {
    return values.size() < 3 ? fallback
                             : Vec3{static_cast<float>(values[0]), static_cast<float>(values[1]),
                                    static_cast<float>(values[2])};
}

/// The index at which a dielectric reflects the share `f0` of light head-on.
double index_of_reflectance(double f0) {
    const double amplitude = std::min(std::sqrt(f0), 0.95);
    return (1.0 + amplitude) / (1.0 - amplitude);
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

/// Stands for the infinite index that an index of 0 means: all light is reflected, at all angles.
constexpr double kInfiniteIndex = 1e4;

/// The index and the strength of reflections from KHR_materials_ior and KHR_materials_specular.
void read_reflections(const tinygltf::Material& source, const SurfaceContext& context,
                      SurfaceModel& surface) {
    constexpr const char* kSpecular = "KHR_materials_specular";
    surface.index = number_of(source.extensions, "KHR_materials_ior", "ior", kUsualIndex);
    if (surface.index == 0.0) {
        surface.index = kInfiniteIndex;
        context.approximate("KHR_materials_ior: an index of 0 is taken for a very large one");
    }
    const double specular = number_of(source.extensions, kSpecular, "specularFactor", 1);
    const Vec3 tint = color_of(source.extensions, kSpecular, "specularColorFactor", {1, 1, 1});
    const double factor = std::max(0.0, specular) * static_cast<double>(std::max(0.0f, luminance(tint)));
    if (tint.x != tint.y || tint.y != tint.z) {
        context.approximate("KHR_materials_specular: the colour of reflections is replaced by its luminance");
    }
    if (texture_of(source.extensions, kSpecular, "specularTexture").index >= 0 ||
        texture_of(source.extensions, kSpecular, "specularColorTexture").index >= 0) {
        context.approximate("KHR_materials_specular: its textures are left out");
    }
    surface.refraction_index = surface.index >= 1.0 ? std::max(surface.index, kMinIndex) : kUsualIndex;
    surface.dielectric_reflects = factor > 0.0 && surface.index > 1.0;
    const double root = (surface.index - 1.0) / (surface.index + 1.0);
    surface.index = surface.dielectric_reflects
                        ? std::max(index_of_reflectance(root * root * factor), kMinIndex)
                        : kMinIndex;
}

/// Metalness and roughness of materials that are given by the colour of their reflections, which take from
/// the diffuse colour as much as their brightest channel has. Those that reflect more than any dielectric and
/// more than they scatter are taken for metals.
void read_specular_glossiness(const tinygltf::Material& source, const SurfaceContext& context,
                              SurfaceModel& surface) {
    context.approximate(std::string(kSpecularGlossiness) + " is converted to metalness and roughness");
    const tinygltf::TextureInfo texture =
        texture_of(source.extensions, kSpecularGlossiness, "specularGlossinessTexture");
    const Vec3 specular =
        clamped(color_of(source.extensions, kSpecularGlossiness, "specularFactor", {1, 1, 1}));
    const auto glossiness =
        static_cast<float>(number_of(source.extensions, kSpecularGlossiness, "glossinessFactor", 1));
    const Parameter reflected = context.textures.textured_by(texture, specular, {}, context.sets);
    surface.roughness =
        texture.index < 0
            ? parameter_of(grey(1.0 - static_cast<double>(glossiness)))
            : context.textures.textured_by(
                  texture, {1, 1, 1}, {.channel = 3, .is_inverse = true, .factor = glossiness}, context.sets);
    const Vec3 mean_reflected = context.textures.mean(reflected);
    surface.color.value = surface.color.value * (1.0f - std::min(max_component(mean_reflected), 1.0f));
    const float mean = luminance(mean_reflected);
    const bool is_metal = mean > 0.25f && mean > luminance(context.textures.mean(surface.color));
    surface.metallic = parameter_of(is_metal ? 1.0f : 0.0f);
    if (is_metal) {
        surface.color = reflected;
    }
    surface.dielectric_reflects = mean > 0.0f;
    surface.index = std::max(index_of_reflectance(std::min(static_cast<double>(mean), 0.25)), kMinIndex);
}

/// KHR_materials_anisotropy, which stretches the microfacets along u: α is that of the roughness across it,
/// and lies between that and 1 along it. The principled model has √(αu·αv) as the square of its roughness,
/// and αv ÷ αu = 1 − 0.9·anisotropic.
void read_anisotropy(const tinygltf::Material& source, const SurfaceContext& context, SurfaceModel& surface) {
    constexpr const char* kAnisotropy = "KHR_materials_anisotropy";
    const double strength =
        std::clamp(number_of(source.extensions, kAnisotropy, "anisotropyStrength", 0), 0.0, 1.0);
    surface.stretched_roughness = surface.roughness;
    if (strength == 0.0) {
        return;
    }
    if (surface.transmits()) {
        context.approximate(std::string(kAnisotropy) + " is left out of glass");
    }
    if (surface.is_glass()) {
        return;
    }
    const double turn = number_of(source.extensions, kAnisotropy, "anisotropyRotation", 0);
    if (std::abs(std::sin(turn)) > 1e-3 ||
        texture_of(source.extensions, kAnisotropy, "anisotropyTexture").index >= 0) {
        context.approximate(std::string(kAnisotropy) + " is left out where it is turned or has a texture");
        return;
    }
    const auto roughness = static_cast<double>(context.textures.mean(surface.roughness).x);
    const double across = std::max(roughness * roughness, 1e-3);
    const double along = across + (1.0 - across) * strength * strength;
    const double anisotropic = (1.0 - across / along) / 0.9;
    if (surface.roughness.texture >= 0 || anisotropic > 1.0) {
        context.approximate(std::string(kAnisotropy) +
                            " stretches reflections up to tenfold, and as at the mean of the roughness");
    }
    surface.anisotropic = static_cast<float>(std::min(anisotropic, 1.0));
    if (surface.roughness.texture >= 0) {
        surface.stretched_roughness.value *= static_cast<float>(std::pow(along / across, 0.25));
    } else {
        surface.stretched_roughness = parameter_of(static_cast<float>(std::pow(along * across, 0.25)));
    }
}

void read_metallic_roughness(const tinygltf::Material& source, const SurfaceContext& context,
                             SurfaceModel& surface) {
    const tinygltf::PbrMetallicRoughness& pbr = source.pbrMetallicRoughness;
    surface.metallic = context.textures.textured_by(pbr.metallicRoughnessTexture, grey(pbr.metallicFactor),
                                                    {.channel = 2}, context.sets);
    surface.roughness = context.textures.textured_by(pbr.metallicRoughnessTexture, grey(pbr.roughnessFactor),
                                                     {.channel = 1}, context.sets);
    read_reflections(source, context, surface);
}

double transmission_factor(const tinygltf::Material& source) {
    return number_of(source.extensions, "KHR_materials_transmission", "transmissionFactor", 0);
}

/// What is left of light at each of the two faces of a body, which absorb half each of what its thickness
/// does. The file has the thickness in the coordinates of the mesh, and the distance in the world.
Vec3 absorption_of(const tinygltf::Material& source, const SurfaceContext& context) {
    context.approximate(
        "KHR_materials_volume: light is absorbed at the faces of glass, as over its thickness");
    const tinygltf::TextureInfo texture = texture_of(source.extensions, kVolume, "thicknessTexture");
    if (texture.index >= 0) {
        context.approximate("KHR_materials_volume: thicknessTexture is replaced by its mean");
    }
    const Parameter share = context.textures.textured_by(texture, {1, 1, 1}, {.channel = 1}, context.sets);
    const Volume volume = volume_of(source);
    const double thickness = volume.thickness * static_cast<double>(context.scale) *
                             static_cast<double>(context.textures.mean(share).x);
    const auto exponent = static_cast<float>(std::min(1e3, 0.5 * thickness / volume.distance));
    return {std::pow(volume.color.x, exponent), std::pow(volume.color.y, exponent),
            std::pow(volume.color.z, exponent)};
}

/// Glass: KHR_materials_transmission and KHR_materials_volume.
void read_glass(const tinygltf::Material& source, const SurfaceContext& context, SurfaceModel& surface) {
    surface.transmission = context.textures.textured_by(
        texture_of(source.extensions, "KHR_materials_transmission", "transmissionTexture"),
        grey(transmission_factor(source)), {.channel = 0}, context.sets);
    const Volume volume = volume_of(source);
    surface.is_thin = volume.is_thin();
    if (surface.transmits() && volume.absorbs()) {
        surface.absorption = absorption_of(source, context);
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
    constexpr std::array<std::string_view, 10> kRead{
        "KHR_materials_anisotropy", "KHR_materials_clearcoat",    "KHR_materials_emissive_strength",
        "KHR_materials_ior",        kSpecularGlossiness,          "KHR_materials_sheen",
        "KHR_materials_specular",   "KHR_materials_transmission", "KHR_materials_unlit",
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

Volume volume_of(const tinygltf::Material& source) {
    return {.thickness = number_of(source.extensions, kVolume, "thicknessFactor", 0),
            .distance = number_of(source.extensions, kVolume, "attenuationDistance", HUGE_VAL),
            .color = clamped(color_of(source.extensions, kVolume, "attenuationColor", {1, 1, 1}))};
}

bool absorbs_inside(const tinygltf::Material& source) {
    return volume_of(source).absorbs() && transmission_factor(source) > 0;
}

bool SurfaceModel::is_diffuse() const {
    const bool is_layered = clearcoat.value.x > 0.0f || sheen.value.x > 0.0f;
    const bool is_fully_rough = roughness.texture < 0 && roughness.value.x >= 1.0f;
    return !is_layered && !is_metal() && (!dielectric_reflects || is_fully_rough);
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
    if (uses_specular_glossiness(source)) {
        read_specular_glossiness(source, context, surface);
    } else {
        read_metallic_roughness(source, context, surface);
    }
    read_glass(source, context, surface);
    read_anisotropy(source, context, surface);
    read_layers(source, context, surface);
    return surface;
}

}  // namespace nearlight::core::gltf
