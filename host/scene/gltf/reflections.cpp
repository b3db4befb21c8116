// SPDX-License-Identifier: Apache-2.0
#include "host/scene/gltf/reflections.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "host/scene/gltf/factors.h"
#include "host/scene/material_model.h"

namespace nearlight::core::gltf {
namespace {

/// The least index of the models, which stands for no reflections.
constexpr double kMinIndex = 1.001;

/// The index at which a dielectric reflects the share `f0` of light head-on.
double index_of_reflectance(double f0) {
    const double amplitude = std::min(std::sqrt(f0), 0.95);
    return (1.0 + amplitude) / (1.0 - amplitude);
}

/// Stands for the infinite index that an index of 0 means: all light is reflected, at all angles.
constexpr double kInfiniteIndex = 1e4;

/// The index and the strength of reflections from KHR_materials_ior and KHR_materials_specular.
void read_index(const tinygltf::Material& source, const SurfaceContext& context, SurfaceModel& surface) {
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

/// The luminance of reflections above which a place is metal, because no common dielectric reflects as much.
constexpr float kLeastOfMetals = 0.25f;

/// What a material reflects in places that are metal and in others.
struct ReflectedParts {
    bool has_metal = false;
    bool has_rest = false;
    Vec3 mean_of_rest{0, 0, 0};
};

ReflectedParts parts_of(const Parameter& reflected, const TextureMaker& textures) {
    ReflectedParts parts;
    std::array<double, 4> sum{};  // of three channels, and how many
    textures.visit_texels(reflected, [&](Vec3 color) {
        if (luminance(color) >= kLeastOfMetals) {
            parts.has_metal = true;
            return;
        }
        const std::array<float, 4> texel{color.x, color.y, color.z, 1.0f};
        for (std::size_t i = 0; i < sum.size(); ++i) {
            sum[i] += static_cast<double>(texel[i]);
        }
    });
    parts.has_rest = sum[3] > 0.0;
    if (parts.has_rest) {
        parts.mean_of_rest = {static_cast<float>(sum[0] / sum[3]), static_cast<float>(sum[1] / sum[3]),
                              static_cast<float>(sum[2] / sum[3])};
    }
    return parts;
}

/// Gives the surface a metalness by the colour of its reflections, which take from the diffuse colour as much
/// as their brightest channel has. A colour for all of the surface is that of a metal only if it reflects
/// more than it scatters.
void part_metal_from_rest(const Parameter& reflected, const TextureMaker& textures, SurfaceModel& surface) {
    ReflectedParts parts = parts_of(reflected, textures);
    if (reflected.texture < 0) {
        const Vec3 scattered = textures.mean(surface.color) * (1.0f - max_component(reflected.value));
        parts.has_metal = parts.has_metal && luminance(reflected.value) > luminance(scattered);
        parts.has_rest = !parts.has_metal;
        parts.mean_of_rest = reflected.value;
    }
    surface.metallic = parameter_of(parts.has_metal ? 1.0f : 0.0f);
    surface.has_metal_color = parts.has_metal && parts.has_rest;
    surface.metal_color = reflected;
    if (parts.has_metal && !parts.has_rest) {
        surface.color = reflected;
        return;
    }
    surface.color.value *= 1.0f - std::min(max_component(parts.mean_of_rest), 1.0f);
    const double mean = static_cast<double>(luminance(parts.mean_of_rest));
    surface.dielectric_reflects = mean > 0.0;
    surface.index =
        std::max(index_of_reflectance(std::min(mean, static_cast<double>(kLeastOfMetals))), kMinIndex);
}

/// Materials that are given by the colour of their reflections.
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
    part_metal_from_rest(reflected, context.textures, surface);
    if (surface.has_metal_color) {
        surface.metallic = context.textures.textured_by(texture, {1, 1, 1}, {.is_number = true}, context.sets,
                                                        0, kLeastOfMetals / luminance(specular));
    }
}

void read_metallic_roughness(const tinygltf::Material& source, const SurfaceContext& context,
                             SurfaceModel& surface) {
    const tinygltf::PbrMetallicRoughness& pbr = source.pbrMetallicRoughness;
    surface.metallic = context.textures.textured_by(pbr.metallicRoughnessTexture, grey(pbr.metallicFactor),
                                                    {.channel = 2}, context.sets);
    surface.roughness = context.textures.textured_by(pbr.metallicRoughnessTexture, grey(pbr.roughnessFactor),
                                                     {.channel = 1}, context.sets);
    read_index(source, context, surface);
}

}  // namespace

void read_reflections(const tinygltf::Material& source, const SurfaceContext& context,
                      SurfaceModel& surface) {
    if (uses_specular_glossiness(source)) {
        read_specular_glossiness(source, context, surface);
    } else {
        read_metallic_roughness(source, context, surface);
    }
}

// The extension stretches the microfacets along u: α is that of the roughness across it, and lies between
// that and 1 along it. The principled model has √(αu·αv) as the square of its roughness, and αv ÷ αu = 1 −
// 0.9·anisotropic.
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

}  // namespace nearlight::core::gltf
