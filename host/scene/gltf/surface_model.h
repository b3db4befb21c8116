// SPDX-License-Identifier: Apache-2.0
// What a glTF material and its extensions say about a surface, as parameters of the scene.
#pragma once

#include "host/scene/gltf/textures.h"
#include "host/scene/material_model.h"

namespace nearlight::core::gltf {

/// The properties that decide which material a glTF material becomes.
struct SurfaceModel {
    Parameter color = parameter_of(1.0f);
    Parameter opacity = parameter_of(1.0f);
    /// From the alpha of vertices, which multiplies the other opacity.
    Parameter vertex_opacity = parameter_of(1.0f);
    Parameter metallic = parameter_of(0.0f);
    /// What is metal has a colour of its own, and `color` is that of the rest.
    bool has_metal_color = false;
    Parameter metal_color = parameter_of(1.0f);
    Parameter roughness = parameter_of(1.0f);  ///< perceptual: the square root of GGX's α
    Parameter emission = parameter_of(0.0f);   ///< a radiance
    Parameter transmission = parameter_of(0.0f);
    /// The share of the diffuse part that goes through, and its colour, as through a thin sheet.
    Parameter diffuse_transmission = parameter_of(0.0f);
    Parameter passed_color = parameter_of(1.0f);
    Parameter clearcoat = parameter_of(0.0f);
    Parameter sheen = parameter_of(0.0f);
    double index = kUsualIndex;             ///< that gives the reflections of what is no metal their strength
    double refraction_index = kUsualIndex;  ///< of glass
    double clearcoat_roughness = 0;
    float anisotropic = 0;  ///< of the principled model, along u
    /// The roughness with which that model makes the stretched reflections.
    Parameter stretched_roughness = parameter_of(1.0f);
    Parameter body_alpha = parameter_of(0.0f);  ///< α of the facets of glass bodies
    Vec3 absorption{1, 1, 1};                   ///< what is left of light at each face of a body
    bool is_thin = true;
    bool dielectric_reflects = true;  ///< metal always does
    bool is_unlit = false;

    /// Whether nothing lies above the base that reflects.
    [[nodiscard]] bool is_diffuse() const;
    [[nodiscard]] bool transmits() const { return transmission.value.x > 0.0f; }
    [[nodiscard]] bool diffuses_through() const { return diffuse_transmission.value.x > 0.0f; }
    [[nodiscard]] bool is_metal() const { return metallic.value.x > 0.0f; }
    [[nodiscard]] bool is_all_metal() const { return metallic.texture < 0 && metallic.value.x >= 1.0f; }
    /// Whether none of it is opaque.
    [[nodiscard]] bool is_glass() const {
        return transmission.texture < 0 && transmission.value.x >= 1.0f && !is_metal();
    }
};

/// What the reader of a material works with.
struct SurfaceContext {
    const GltfFile& file;
    TextureMaker& textures;
    NoteSink& notes;
    TextureSets sets;
    bool has_colors = false;
    bool has_alphas = false;  ///< vertices have an alpha, see TextureMaker::vertex_number()
    float scale = 1;          ///< of lengths from the mesh to the world

    void approximate(const std::string& what) const { notes.approximation(file.path, 0, what); }
};

inline constexpr const char* kSpecularGlossiness = "KHR_materials_pbrSpecularGlossiness";

/// Whether a material is to be made of KHR_materials_pbrSpecularGlossiness. Where textures of the
/// metallic-roughness model stand beside it, these are used, because nothing of them has to be converted.
bool uses_specular_glossiness(const tinygltf::Material& source);

/// Whether the material has holes, or lets light through.
bool has_opacity(const tinygltf::Material& source);

/// Whether the material's colours are to be multiplied by the alpha of vertices, because they are light that
/// comes from surfaces which let some through.
bool shines_by_alpha(const tinygltf::Material& source);

/// Reads the material. What cannot be represented is noted by the name of its extension.
SurfaceModel read_surface(const tinygltf::Material& source, const SurfaceContext& context);

}  // namespace nearlight::core::gltf
