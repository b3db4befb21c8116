// SPDX-License-Identifier: Apache-2.0
// Materials of every model, for tests of BSDFs.
#pragma once

#include <map>

#include "host/scene/transmission_curve.h"
#include "tests/support/bsdf_probe.h"

namespace nearlight::core::test {

inline constexpr Vec3 kBase{0.8f, 0.4f, 0.2f};

/// What make_layered() has over its base.
inline constexpr Layers kLayers{.eta = 1.5, .roughness = 0.6, .clearcoat = 0.8, .sheen = 0.5};

/// T = 1 − Schlick's weight / 2 as row 1, the transmittance of a smooth boundary of index 1.5 as row 2, and
/// that of kLayers as row 3.
inline std::vector<float> make_curves() {
    std::vector<float> curves(3 * NEARLIGHT_CURVE_SIZE, 1.0f);
    const TransmissionCurve layered = layered_curve(kLayers);
    curves.insert(curves.end(), layered.begin(), layered.end());
    for (int i = 0; i < NEARLIGHT_CURVE_SIZE; ++i) {
        const double c = i / (NEARLIGHT_CURVE_SIZE - 1.0);
        const double far = std::sqrt(1 - (1 - c * c) / (1.5 * 1.5));
        const double p = (1.5 * c - far) / (1.5 * c + far);
        const double s = (c - 1.5 * far) / (c + 1.5 * far);
        curves[NEARLIGHT_CURVE_SIZE + i] = static_cast<float>(1 - 0.5 * std::pow(1 - c, 5));
        curves[2 * NEARLIGHT_CURVE_SIZE + i] = static_cast<float>(1 - 0.5 * (p * p + s * s));
    }
    return curves;
}

inline Material make_diffuse(Parameter reflectance) {
    Material material = make_material(NEARLIGHT_BSDF_DIFFUSE);
    material.reflectance = reflectance;
    return material;
}

/// A mask, a blend, a map or another material that stands for its children.
inline Material make_wrapper(uint model, Parameter parameter, uint child0, uint child1) {
    Material material = make_material(model);
    material.reflectance = parameter;
    material.child[0] = child0;
    material.child[1] = child1;
    return material;
}

inline Material make_metal(float alpha_x, float alpha_y, uint flags, Vec3 eta, Vec3 k) {
    Material material = make_material(NEARLIGHT_BSDF_CONDUCTOR);
    material.roughness = constant(Vec3{alpha_x, alpha_y, 0});
    material.eta = eta;
    material.k = k;
    material.flags = flags;
    return material;
}

inline Material make_glass(float alpha_x, float alpha_y, uint flags) {
    Material material = make_material(NEARLIGHT_BSDF_DIELECTRIC);
    material.roughness = constant(Vec3{alpha_x, alpha_y, 0});
    material.flags = flags;
    return material;
}

inline Material make_plastic(float alpha, uint flags) {
    Material material = make_material(NEARLIGHT_BSDF_PLASTIC);
    material.roughness = constant(alpha);
    material.reflectance = constant(kBase);
    material.internal_reflectance = 0.596811f;
    material.curve = 2;
    material.flags = flags;
    return material;
}

/// A Lambertian base with a lobe of gloss beside it.
inline Material make_lobe(uint model, float alpha_x, float alpha_y) {
    Material material = make_material(model);
    material.roughness = constant(Vec3{alpha_x, alpha_y, 0});
    material.reflectance = constant(Vec3{0.5f, 0.3f, 0.2f});
    material.specular = constant(Vec3{0.3f, 0.4f, 0.5f});
    return material;
}

inline Material make_principled(uint flags) {
    Material material = make_material(NEARLIGHT_BSDF_PRINCIPLED);
    material.flags = flags;
    material.curve = 1;
    material.reflectance = constant(kBase);
    material.roughness = constant(0.6f);
    material.sheen = constant(0.8f);
    material.sheen_tint = constant(0.5f);
    material.flatness = constant(0.5f);
    material.spec_tint = constant(0.6f);
    material.anisotropic = constant(0.3f);
    if (flags & NEARLIGHT_MATERIAL_THIN) {
        material.spec_trans = constant(0.4f);
        material.transmission = constant(0.4f);
    } else {
        material.metallic = constant(0.4f);
        material.spec_trans = constant(0.3f);
        material.clearcoat = constant(0.9f);
        material.clearcoat_gloss = constant(0.3f);
    }
    return material;
}

inline Material make_layered(Vec3 base) {
    Material material = make_material(NEARLIGHT_BSDF_PRINCIPLED);
    material.flags = NEARLIGHT_MATERIAL_LAYERED;
    material.curve = 3;
    material.reflectance = constant(base);
    material.roughness = constant(static_cast<float>(kLayers.roughness));
    material.clearcoat = constant(static_cast<float>(kLayers.clearcoat));
    material.sheen = constant(static_cast<float>(kLayers.sheen));
    return material;
}

inline std::map<std::string, Material> make_materials() {
    constexpr uint kBeckmann = NEARLIGHT_MATERIAL_BECKMANN;
    const Vec3 eta{0.2f, 0.92f, 1.1f};
    const Vec3 k{3.9f, 2.45f, 2.1f};
    std::map<std::string, Material> materials;
    materials["diffuse"] = make_diffuse(constant(kBase));
    materials["conductor_ggx"] = make_metal(0.15f, 0.4f, 0, eta, k);
    materials["conductor_ggx"].specular = constant(Vec3{0.9f, 0.8f, 0.7f});
    materials["conductor_beckmann"] = make_metal(0.15f, 0.4f, kBeckmann, eta, k);
    materials["dielectric_ggx"] = make_glass(0.2f, 0.35f, 0);
    materials["dielectric_ggx"].transmission = constant(kBase);
    materials["dielectric_beckmann"] = make_glass(0.2f, 0.35f, kBeckmann);
    materials["plastic"] = make_plastic(0, 0);
    materials["plastic_nonlinear"] = make_plastic(0, NEARLIGHT_MATERIAL_NONLINEAR);
    materials["rough_plastic"] = make_plastic(0.3f, 0);
    for (const float alpha : {0.05f, 0.4f, 1.0f}) {
        materials["phong " + std::to_string(alpha)] = make_lobe(NEARLIGHT_BSDF_PHONG, alpha, alpha);
    }
    materials["ward"] = make_lobe(NEARLIGHT_BSDF_WARD, 0.3f, 0.3f);
    materials["ward anisotropic"] = make_lobe(NEARLIGHT_BSDF_WARD, 0.1f, 0.4f);
    materials["principled"] = make_principled(0);
    materials["principled_thin"] = make_principled(NEARLIGHT_MATERIAL_THIN);
    materials["layered"] = make_layered(kBase);
    materials["white layered"] = make_layered({1, 1, 1});
    materials["principled bubble"] = make_principled(0);
    materials["principled bubble"].eta = {0.8f, 0.8f, 0.8f};
    materials["principled of index 1"] = make_principled(0);
    materials["principled of index 1"].eta = {1, 1, 1};
    materials["principled of index 1"].spec_trans = constant(0.0f);
    materials["glass without mirror images"] = make_glass(0.5f, 0.5f, 0);
    materials["glass without mirror images"].specular = constant(0.0f);
    for (const float alpha : {0.1f, 0.3f, 1.0f}) {
        for (const uint flags : {0u, kBeckmann}) {
            const std::string name = (flags ? "beckmann " : "ggx ") + std::to_string(alpha);
            materials["white metal " + name] = make_metal(alpha, alpha, flags, {0, 0, 0}, {1, 1, 1});
            materials["white glass " + name] = make_glass(alpha, alpha, flags);
        }
    }
    materials["white mirror"] = make_metal(0, 0, 0, {0, 0, 0}, {1, 1, 1});
    materials["white smooth glass"] = make_glass(0, 0, 0);
    materials["white pane"] = make_material(NEARLIGHT_BSDF_THIN_DIELECTRIC);
    materials["white null"] = make_material(NEARLIGHT_BSDF_NULL);
    materials["white plastic"] = make_plastic(0, 0);
    materials["white plastic"].reflectance = constant(1.0f);
    return materials;
}

inline BsdfScene scene_of(const Material& material) {
    BsdfScene scene;
    scene.materials = {material};
    scene.curves = make_curves();
    return scene;
}

}  // namespace nearlight::core::test
