// SPDX-License-Identifier: Apache-2.0
// Makes materials of each model from physical parameters.
#pragma once

#include <span>

#include "kernels/shared/types.h"

namespace nearlight::core {

struct Scene;

/// The index of refraction of glass, plastics and varnish, where a file says nothing else.
inline constexpr double kUsualIndex = 1.5;

/// The unpolarised Fresnel reflectance of a dielectric, where eta = index behind ÷ index in front.
double dielectric_reflectance(double cosine, double eta);
/// The unpolarised Fresnel reflectance of a conductor with complex index eta + i·k.
double conductor_reflectance(double cosine, double eta, double k);
/// The mean of dielectric_reflectance() over directions, weighted by cosine: 2 ∫ F(μ) μ dμ.
double mean_dielectric_reflectance(double eta);
/// The mean of conductor_reflectance() over directions, weighted by cosine.
double mean_conductor_reflectance(double eta, double k);

/// Parameters without a texture, and a texture's own values scaled.
constexpr Parameter parameter_of(Vec3 color) {
    return {color, -1};
}
constexpr Parameter parameter_of(float number) {
    return {{number, number, number}, -1};
}
constexpr Parameter textured(int texture, float scale = 1.0f) {
    return {{scale, scale, scale}, texture};
}

/// All parameters of a material.
inline constexpr Parameter Material::*kMaterialParameters[] = {
    &Material::reflectance, &Material::specular,       &Material::transmission, &Material::roughness,
    &Material::emission,    &Material::metallic,       &Material::anisotropic,  &Material::spec_trans,
    &Material::spec_tint,   &Material::sheen,          &Material::sheen_tint,   &Material::flatness,
    &Material::clearcoat,   &Material::clearcoat_gloss};

/// A material of the model that is white where it reflects or lets light through, smooth, emits nothing, and
/// has the index kUsualIndex. Its parameters have no textures, and its D has no curve.
Material plain_material(uint model);
/// A one-sided Lambertian material; `reflectance` is in [0, 1].
Material diffuse_material(Vec3 reflectance);
/// A smooth conductor with complex index eta + i·k, whose reflectance `specular` scales.
Material conductor_material(Vec3 eta, Vec3 k, Vec3 specular = {1, 1, 1});
/// The boundary of a smooth glass body; eta = interior ÷ exterior index.
Material dielectric_material(double eta);
/// A pane of glass, both faces at once.
Material thin_dielectric_material(double eta);

/// What lies on the base of a plastic.
struct Coat {
    double eta = kUsualIndex;  ///< interior ÷ exterior index
    double alpha = 0.0;        ///< roughness of the microfacets; smooth below NEARLIGHT_MIN_ALPHA
    bool beckmann = false;     ///< their distribution; otherwise GGX
    bool nonlinear = false;    ///< colours saturate by inter-reflection below the coat

    auto operator<=>(const Coat&) const = default;
};
/// A white base under the coat. Adds the coat's transmission curve to the scene.
Material plastic_material(Scene& scene, const Coat& coat);
/// A principled material with its curve; roughness 0.5, all else 0, white.
Material principled_material(Scene& scene, double eta);

/// `front` and `back` are indices of materials, as `child` is below.
Material two_sided_material(uint front, uint back);
Material mask_material(Parameter opacity, uint child);
/// `second` where the weight is 1, `first` where it is 0.
Material blend_material(Parameter weight, uint first, uint second);
Material normal_map_material(Parameter map, uint child);
/// `height` is in metres.
Material bump_map_material(Parameter height, uint child);

/// Whether the material is a mask, a blend, two sides or a map, and other materials reflect in its place.
constexpr bool stands_for_others(const Material& material) {
    return material.model >= NEARLIGHT_BSDF_MASK;
}
/// The indices of the materials that one may stand for.
std::span<const uint> children(const Material& material);
/// How many materials lie within each other below this one: 0 if it stands for no others.
int nesting(const Scene& scene, const Material& material);

/// Whether anything of the material, or of those that it stands for, is looked up by texture coordinates.
bool has_placed_textures(const Scene& scene, const Material& material);

/// Adds the two-sided material of a one-sided one, whose emission it takes over; returns its index.
uint add_two_sided(Scene& scene, const Material& material);

}  // namespace nearlight::core
