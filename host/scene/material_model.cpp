// SPDX-License-Identifier: Apache-2.0
#include "host/scene/material_model.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "host/base/math.h"
#include "host/scene/scene.h"
#include "host/scene/transmission_curve.h"

namespace nearlight::core {
namespace {

template <typename Reflectance>
double cosine_mean(Reflectance reflectance) {
    constexpr int kSteps = 2048;
    double sum = 0.0;
    for (int i = 0; i < kSteps; ++i) {
        const double cosine = (i + 0.5) / kSteps;
        sum += reflectance(cosine) * cosine;
    }
    return 2.0 * sum / kSteps;
}

Vec3 grey(double value) {
    return Vec3{1, 1, 1} * static_cast<float>(value);
}

/// A material that stands for `child`.
Material wrapper_material(uint model, Parameter parameter, uint child) {
    Material material = plain_material(model);
    material.reflectance = parameter;
    material.child[0] = child;
    material.child[1] = child;
    return material;
}

/// A plastic with the same coat, whose integrals over microfacets can be taken over; null if there is none.
/// Varnish (no internal reflectance) has not computed all of them, so it is passed over.
const Material* find_coat(std::span<const Material> materials, const Material& plastic) {
    const auto facets = [](const Material& m) { return m.flags & NEARLIGHT_MATERIAL_BECKMANN; };
    const auto twin = std::find_if(materials.begin(), materials.end(), [&](const Material& other) {
        return other.model == NEARLIGHT_BSDF_PLASTIC && other.internal_reflectance > 0.0f &&
               other.roughness.texture < 0 && other.roughness.value.x == plastic.roughness.value.x &&
               other.eta.x == plastic.eta.x && facets(other) == facets(plastic);
    });
    return twin == materials.end() ? nullptr : &*twin;
}

}  // namespace

double dielectric_reflectance(double cosine, double eta) {
    const double sine2_behind = (1.0 - cosine * cosine) / (eta * eta);
    if (sine2_behind >= 1.0) {
        return 1.0;
    }
    const double cosine_behind = std::sqrt(1.0 - sine2_behind);
    const double s = (cosine - eta * cosine_behind) / (cosine + eta * cosine_behind);
    const double p = (eta * cosine - cosine_behind) / (eta * cosine + cosine_behind);
    return 0.5 * (s * s + p * p);
}

double conductor_reflectance(double cosine, double eta, double k) {
    const double cosine2 = cosine * cosine;
    const double sine2 = 1.0 - cosine2;
    const double t0 = eta * eta - k * k - sine2;
    const double a2_plus_b2 = std::sqrt(t0 * t0 + 4.0 * eta * eta * k * k);
    const double a = std::sqrt(std::max(0.0, 0.5 * (a2_plus_b2 + t0)));
    const double t1 = a2_plus_b2 + cosine2;
    const double t2 = 2.0 * a * cosine;
    const double s = (t1 - t2) / (t1 + t2);
    const double t3 = cosine2 * a2_plus_b2 + sine2 * sine2;
    const double t4 = t2 * sine2;
    return 0.5 * s * (1.0 + (t3 - t4) / (t3 + t4));
}

double mean_dielectric_reflectance(double eta) {
    return cosine_mean([&](double cosine) { return dielectric_reflectance(cosine, eta); });
}

double mean_conductor_reflectance(double eta, double k) {
    return cosine_mean([&](double cosine) { return conductor_reflectance(cosine, eta, k); });
}

Material plain_material(uint model) {
    const Parameter zero = parameter_of(0.0f);
    const Parameter one = parameter_of(1.0f);
    Material material{};
    material.reflectance = material.specular = material.transmission = one;
    material.roughness = material.emission = material.metallic = material.anisotropic = zero;
    material.spec_trans = material.spec_tint = material.sheen = material.sheen_tint = zero;
    material.flatness = material.clearcoat = material.clearcoat_gloss = zero;
    material.eta = grey(kUsualIndex);
    material.model = model;
    return material;
}

Material diffuse_material(Vec3 reflectance) {
    Material material = plain_material(NEARLIGHT_BSDF_DIFFUSE);
    material.reflectance = parameter_of(reflectance);
    return material;
}

Material conductor_material(Vec3 eta, Vec3 k, Vec3 specular) {
    Material material = plain_material(NEARLIGHT_BSDF_CONDUCTOR);
    material.specular = parameter_of(specular);
    material.eta = eta;
    material.k = k;
    return material;
}

Material dielectric_material(double eta) {
    Material material = plain_material(NEARLIGHT_BSDF_DIELECTRIC);
    material.eta = grey(eta);
    return material;
}

Material thin_dielectric_material(double eta) {
    Material material = plain_material(NEARLIGHT_BSDF_THIN_DIELECTRIC);
    material.eta = grey(eta);
    return material;
}

Material plastic_material(Scene& scene, const Coat& coat) {
    Material material = plain_material(NEARLIGHT_BSDF_PLASTIC);
    material.roughness = parameter_of(static_cast<float>(coat.alpha));
    material.eta = grey(coat.eta);
    material.flags = (coat.beckmann ? NEARLIGHT_MATERIAL_BECKMANN : 0u) |
                     (coat.nonlinear ? NEARLIGHT_MATERIAL_NONLINEAR : 0u);
    if (const Material* twin = find_coat(scene.materials, material)) {
        material.curve = twin->curve;
        material.internal_reflectance = twin->internal_reflectance;
    } else if (coat.alpha < static_cast<double>(NEARLIGHT_MIN_ALPHA)) {
        material.curve = add_curve(scene, smooth_coat_curve(coat.eta));
        material.internal_reflectance = static_cast<float>(smooth_internal_reflectance(coat.eta));
    } else {
        material.curve = add_curve(scene, rough_coat_curve(coat.eta, coat.alpha, coat.beckmann));
        material.internal_reflectance =
            static_cast<float>(rough_internal_reflectance(coat.eta, coat.alpha, coat.beckmann));
    }
    return material;
}

Material principled_material(Scene& scene, double eta) {
    Material material = plain_material(NEARLIGHT_BSDF_PRINCIPLED);
    material.roughness = parameter_of(0.5f);
    material.eta = grey(eta);
    material.curve = add_curve(scene, principled_curve());
    return material;
}

Material two_sided_material(uint front, uint back) {
    Material material = wrapper_material(NEARLIGHT_BSDF_TWO_SIDED, parameter_of(1.0f), front);
    material.child[1] = back;
    return material;
}

Material mask_material(Parameter opacity, uint child) {
    return wrapper_material(NEARLIGHT_BSDF_MASK, opacity, child);
}

Material blend_material(Parameter weight, uint first, uint second) {
    Material material = wrapper_material(NEARLIGHT_BSDF_BLEND, weight, first);
    material.child[1] = second;
    return material;
}

Material normal_map_material(Parameter map, uint child) {
    Material material = wrapper_material(NEARLIGHT_BSDF_NORMAL_MAP, map, child);
    material.flags |= NEARLIGHT_MATERIAL_TANGENT;
    return material;
}

Material bump_map_material(Parameter height, uint child) {
    Material material = wrapper_material(NEARLIGHT_BSDF_BUMP_MAP, height, child);
    material.flags |= NEARLIGHT_MATERIAL_TANGENT;
    return material;
}

std::span<const uint> children(const Material& material) {
    const bool has_two = material.model == NEARLIGHT_BSDF_BLEND || material.model == NEARLIGHT_BSDF_TWO_SIDED;
    return {material.child, stands_for_others(material) ? (has_two ? 2u : 1u) : 0u};
}

int nesting(const Scene& scene, const Material& material) {
    int levels = 0;
    for (const uint child : children(material)) {
        levels = std::max(levels, 1 + nesting(scene, scene.materials[child]));
    }
    return levels;
}

bool has_placed_textures(const Scene& scene, const Material& material) {
    const auto is_placed = [&](const Parameter& parameter) {
        return parameter.texture >= 0 &&
               scene.textures[static_cast<std::size_t>(parameter.texture)].parameters.kind !=
                   NEARLIGHT_TEXTURE_VERTEX_COLOR;
    };
    const std::span parameters(&material.reflectance, NEARLIGHT_PARAMETER_COUNT);
    return std::ranges::any_of(parameters, is_placed) ||
           std::ranges::any_of(children(material), [&](uint child) {
               return has_placed_textures(scene, scene.materials[child]);
           });
}

uint add_two_sided(Scene& scene, const Material& material) {
    const auto side = static_cast<uint>(scene.materials.size());
    scene.materials.push_back(material);
    scene.materials.back().emission = parameter_of(0.0f);
    scene.materials.push_back(two_sided_material(side, side));
    scene.materials.back().emission = material.emission;
    return side + 1;
}

}  // namespace nearlight::core
