// SPDX-License-Identifier: Apache-2.0
// Materials of every model, each on a square in the plane z = 0 that faces +z, with texture coordinates along
// x and y.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "host/base/random.h"
#include "host/reference/bsdf/surface_bsdf.h"
#include "host/scene/layered_materials.h"
#include "tests/support/small_scenes.h"

namespace nearlight::core::small_scenes {

struct BsdfCase {
    std::string name;
    Scene scene;
    bool conserves_energy = true;  ///< the principled model's sheen and clearcoat do not

    /// The BSDF at (0.5, 0.25), seen from `wo`.
    [[nodiscard]] SurfaceBsdf seen_from(Vec3d wo, Transport transport = Transport::radiance,
                                        double choice = 0.5) const {
        const BvhHit hit{1.0f, 0.25f, 0.25f, 0};  // the point (0.5, 0.25)
        return {scene, surface_at(scene, hit, -as_float(wo)), wo, choice, transport};
    }
};

/// A scene with the square; `make` returns the index of its material.
inline Scene square_of(const std::function<uint(Scene&)>& make) {
    Scene scene;
    const uint material = make(scene);
    add_quad(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, material);
    for (Vertex& vertex : scene.vertices) {
        vertex.u = vertex.position.x;
        vertex.v = vertex.position.y;
    }
    return scene;
}

inline BsdfCase bsdf_case(const std::string& name, const std::function<Material(Scene&)>& make,
                          bool conserves_energy = true) {
    return {name, square_of([&](Scene& scene) { return add_material(scene, make(scene)); }),
            conserves_energy};
}

inline Material rough(Material material, float alpha_u, float alpha_v, bool beckmann = false) {
    material.roughness = parameter_of(Vec3{alpha_u, alpha_v, 0});
    material.flags |= beckmann ? NEARLIGHT_MATERIAL_BECKMANN : 0u;
    return material;
}

inline Material colored(Material material, Vec3 color) {
    material.reflectance = parameter_of(color);
    return material;
}

inline Material gold() {
    return conductor_material({0.143f, 0.375f, 1.442f}, {3.983f, 2.386f, 1.603f});
}

/// A principled material; `change` sets more than colour, roughness and index.
inline Material principled(Scene& scene, float roughness, const std::function<void(Material&)>& change = {}) {
    Material material = colored(principled_material(scene, 1.5), {0.7f, 0.4f, 0.2f});
    material.roughness = parameter_of(roughness);
    if (change) {
        change(material);
    }
    return material;
}

inline std::vector<BsdfCase> opaque_cases() {
    const Vec3 red{0.8f, 0.3f, 0.1f};
    std::vector<BsdfCase> cases;
    const auto add = [&](const std::string& name, const auto& make) {
        cases.push_back(bsdf_case(name, make));
    };
    add("diffuse", [&](Scene&) { return lambertian(red); });
    add("plastic", [&](Scene& s) { return colored(plastic_material(s, {.eta = 1.49}), red); });
    add("plastic nonlinear",
        [&](Scene& s) { return colored(plastic_material(s, {.eta = 1.49, .nonlinear = true}), red); });
    add("rough plastic GGX",
        [&](Scene& s) { return colored(plastic_material(s, {.eta = 1.49, .alpha = 0.3}), red); });
    add("rough plastic Beckmann nonlinear", [&](Scene& s) {
        return colored(plastic_material(s, {.eta = 1.49, .alpha = 0.2, .beckmann = true, .nonlinear = true}),
                       red);
    });
    add("conductor", [&](Scene&) { return gold(); });
    add("rough conductor GGX", [&](Scene&) { return rough(gold(), 0.4f, 0.4f); });
    add("anisotropic conductor GGX", [&](Scene&) { return rough(gold(), 0.2f, 0.6f); });
    add("rough conductor Beckmann", [&](Scene&) { return rough(gold(), 0.3f, 0.3f, true); });
    add("anisotropic conductor Beckmann", [&](Scene&) { return rough(gold(), 0.5f, 0.2f, true); });
    const auto lobe = [&](uint model) {
        Material material = colored(plain_material(model), red * 0.5f);
        material.specular = parameter_of(Vec3{0.4f, 0.5f, 0.6f});
        return material;
    };
    add("Phong wide", [&](Scene&) { return rough(lobe(NEARLIGHT_BSDF_PHONG), 0.8f, 0.8f); });
    add("Phong narrow", [&](Scene&) { return rough(lobe(NEARLIGHT_BSDF_PHONG), 0.2f, 0.2f); });
    add("Ward", [&](Scene&) { return rough(lobe(NEARLIGHT_BSDF_WARD), 0.3f, 0.3f); });
    add("anisotropic Ward", [&](Scene&) { return rough(lobe(NEARLIGHT_BSDF_WARD), 0.2f, 0.5f); });
    return cases;
}

inline std::vector<BsdfCase> glass_cases() {
    std::vector<BsdfCase> cases;
    const auto add = [&](const std::string& name, const auto& make) {
        cases.push_back(bsdf_case(name, make));
    };
    add("dielectric", [&](Scene&) { return dielectric_material(1.5); });
    add("thin dielectric", [&](Scene&) { return thin_dielectric_material(1.5); });
    add("rough dielectric GGX", [&](Scene&) { return rough(dielectric_material(1.5), 0.4f, 0.4f); });
    add("rough dielectric Beckmann",
        [&](Scene&) { return rough(dielectric_material(1.33), 0.3f, 0.3f, true); });
    // Where the boundary as a whole would reflect all, leaning facets let light through.
    add("rough dielectric without mirror images", [&](Scene&) {
        Material material = rough(dielectric_material(1.5), 0.5f, 0.5f);
        material.specular = parameter_of(0.0f);
        return material;
    });
    add("anisotropic dielectric GGX", [&](Scene&) { return rough(dielectric_material(1.5), 0.2f, 0.5f); });
    add("null", [&](Scene&) { return plain_material(NEARLIGHT_BSDF_NULL); });
    return cases;
}

/// What glTF and MTL files describe: a base below facets, clearcoat and sheen.
inline std::vector<BsdfCase> layered_cases() {
    std::vector<BsdfCase> cases;
    const auto add = [&](const std::string& name, const Layers& layers, float metallic) {
        cases.push_back(bsdf_case(name, [&](Scene& scene) {
            Material material = LayeredMaterials().of(scene, layers);
            material.roughness = parameter_of(static_cast<float>(layers.roughness));
            material.clearcoat = parameter_of(static_cast<float>(layers.clearcoat));
            material.clearcoat_gloss = parameter_of(0.5f);
            material.sheen = parameter_of(static_cast<float>(layers.sheen));
            material.metallic = parameter_of(metallic);
            return material;
        }));
    };
    add("layered white", {.roughness = 0.5}, 0.0f);
    add("layered white matt", {.roughness = 1}, 0.0f);
    add("layered white dense", {.eta = 3, .roughness = 0.25}, 0.0f);
    add("layered half metal", {.roughness = 0.5}, 0.5f);
    add("layered white coated", {.roughness = 0.75, .clearcoat = 1}, 0.0f);
    add("layered white fabric", {.roughness = 0.75, .sheen = 1}, 0.0f);
    return cases;
}

inline std::vector<BsdfCase> principled_cases() {
    std::vector<BsdfCase> cases;
    const auto add = [&](const std::string& name, float roughness, bool conserves, const auto& change) {
        cases.push_back(bsdf_case(
            name, [&](Scene& s) { return principled(s, roughness, change); }, conserves));
    };
    add("principled", 0.6f, false, [](Material&) {});
    add("principled metal", 0.6f, true, [](Material& m) {
        m.metallic = parameter_of(1.0f);
        m.anisotropic = parameter_of(0.7f);
    });
    add("principled fabric", 0.7f, false, [](Material& m) {
        m.sheen = parameter_of(0.8f);
        m.sheen_tint = parameter_of(0.5f);
        m.flatness = parameter_of(0.6f);
        m.spec_tint = parameter_of(0.7f);
    });
    add("principled coated", 0.5f, false, [](Material& m) {
        m.clearcoat = parameter_of(1.0f);
        m.clearcoat_gloss = parameter_of(0.2f);
        m.metallic = parameter_of(0.3f);
    });
    add("principled glass", 0.6f, true, [](Material& m) { m.spec_trans = parameter_of(1.0f); });
    add("principled half glass", 0.6f, false, [](Material& m) { m.spec_trans = parameter_of(0.6f); });
    add("principled thin", 0.6f, false, [](Material& m) {
        m.flags |= NEARLIGHT_MATERIAL_THIN;
        m.transmission = parameter_of(0.3f);
        m.spec_trans = parameter_of(0.5f);
        m.spec_tint = parameter_of(0.4f);
        m.sheen = parameter_of(0.3f);
        m.flatness = parameter_of(0.4f);
    });
    return cases;
}

inline std::vector<BsdfCase> all_bsdf_cases() {
    std::vector<BsdfCase> cases = opaque_cases();
    for (const auto& more : {glass_cases(), principled_cases(), layered_cases()}) {
        cases.insert(cases.end(), more.begin(), more.end());
    }
    return cases;
}

/// The unit vector with this cosine to +z, at an azimuth.
inline Vec3d towards(double cosine, double azimuth = 0.4) {
    const double sine = std::sqrt(1 - cosine * cosine);
    return {sine * std::cos(azimuth), sine * std::sin(azimuth), cosine};
}

inline BsdfRandom next_random(Pcg32& random) {
    const double choice = random.uniform();
    const double x = random.uniform();
    return {choice, x, random.uniform()};
}

/// The integral of `value`(direction) over the sphere by the midpoint rule.
template <typename Function>
Vec3d sphere_quadrature(int steps, const Function& value) {
    Vec3d sum;
    for (int i = 0; i < 2 * steps; ++i) {
        for (int j = 0; j < 2 * steps; ++j) {
            const double cosine = -1 + (i + 0.5) / steps;
            sum += value(towards(cosine, std::numbers::pi * (j + 0.5) / steps));
        }
    }
    return sum * (std::numbers::pi / (double(steps) * steps));
}

}  // namespace nearlight::core::small_scenes
