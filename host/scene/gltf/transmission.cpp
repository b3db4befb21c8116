// SPDX-License-Identifier: Apache-2.0
#include "host/scene/gltf/transmission.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "host/scene/gltf/factors.h"

namespace nearlight::core::gltf {
namespace {

constexpr const char* kVolume = "KHR_materials_volume";
constexpr const char* kDiffuseTransmission = "KHR_materials_diffuse_transmission";

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

/// α of the facets of a glass body: the square of the roughness, at each texel where it has a texture.
Parameter alpha_of_body(const tinygltf::Material& source, const SurfaceContext& context,
                        const SurfaceModel& surface) {
    if (surface.roughness.texture >= 0 && !uses_specular_glossiness(source)) {
        const float factor = surface.roughness.value.x;
        return context.textures.textured_by(source.pbrMetallicRoughness.metallicRoughnessTexture,
                                            Vec3{1, 1, 1} * (factor * factor),
                                            {.gamma = 2.0f, .channel = 1, .is_encoded = true}, context.sets);
    }
    if (surface.roughness.texture >= 0) {
        context.approximate(std::string(kSpecularGlossiness) +
                            ": textures of the glossiness of glass bodies are replaced by their means");
    }
    const float roughness = context.textures.mean(surface.roughness).x;
    return parameter_of(roughness * roughness);
}

/// What KHR_materials_diffuse_transmission says of leaves, curtains and lampshades.
void read_diffuse_transmission(const tinygltf::Material& source, const SurfaceContext& context,
                               SurfaceModel& surface) {
    const double factor = number_of(source.extensions, kDiffuseTransmission, "diffuseTransmissionFactor", 0);
    if (!(factor > 0) || surface.is_all_metal()) {
        return;
    }
    surface.diffuse_transmission = context.textures.textured_by(
        texture_of(source.extensions, kDiffuseTransmission, "diffuseTransmissionTexture"), grey(factor),
        {.channel = 3}, context.sets);
    const Vec3 color =
        color_of(source.extensions, kDiffuseTransmission, "diffuseTransmissionColorFactor", {1, 1, 1});
    surface.passed_color = context.textures.textured_by(
        texture_of(source.extensions, kDiffuseTransmission, "diffuseTransmissionColorTexture"),
        clamped(color), {}, context.sets);
    if (!surface.is_thin) {
        context.approximate(std::string(kDiffuseTransmission) +
                            ": bodies are taken for thin sheets, which absorb nothing inside");
    }
}

}  // namespace

Volume volume_of(const tinygltf::Material& source) {
    return {.thickness = number_of(source.extensions, kVolume, "thicknessFactor", 0),
            .distance = number_of(source.extensions, kVolume, "attenuationDistance", HUGE_VAL),
            .color = clamped(color_of(source.extensions, kVolume, "attenuationColor", {1, 1, 1}))};
}

bool absorbs_inside(const tinygltf::Material& source) {
    return volume_of(source).absorbs() && transmission_factor(source) > 0;
}

void read_transmission(const tinygltf::Material& source, const SurfaceContext& context,
                       SurfaceModel& surface) {
    surface.transmission = context.textures.textured_by(
        texture_of(source.extensions, "KHR_materials_transmission", "transmissionTexture"),
        grey(transmission_factor(source)), {.channel = 0}, context.sets);
    const Volume volume = volume_of(source);
    surface.is_thin = volume.is_thin();
    if (surface.transmits() && !surface.is_thin) {
        surface.body_alpha = alpha_of_body(source, context, surface);
    }
    if (surface.transmits() && volume.absorbs()) {
        surface.absorption = absorption_of(source, context);
    }
    read_diffuse_transmission(source, context, surface);
}

}  // namespace nearlight::core::gltf
