// SPDX-License-Identifier: Apache-2.0
#include "host/scene/material_model.h"

#include <algorithm>
#include <cmath>

#include "host/base/math.h"

namespace nearlight::core {
namespace {

// Even in a closed room of metal, light must die out.
constexpr float kMaxConductorAlbedo = 0.99f;

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

Material empty_material() {
    Material material{};
    material.base_texture = -1;
    material.specular = {1, 1, 1};
    material.transmission = {1, 1, 1};
    material.eta = {1, 1, 1};
    material.lobe = NEARLIGHT_LOBE_NONE;
    return material;
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

Material diffuse_material(Vec3 reflectance) {
    Material material = empty_material();
    material.base = reflectance;
    material.base_scale = 1.0f;
    material.light_scale = 1.0f;
    return material;
}

// Entering light is weighted by 1 − F outside and leaving light by 1 − F over η²; between the two it bounces
// below the coat, whose mean reflectance from inside follows from reciprocity: 1 − F_in = (1 − F_out)/η².
Material coat_material(Vec3 reflectance, Vec3 specular, double eta, float roughness, bool nonlinear) {
    const double outside = mean_dielectric_reflectance(eta);
    const double leaving = (1.0 - outside) / (eta * eta);
    const double inside = 1.0 - leaving;
    const double linear_factor = nonlinear ? 1.0 : 1.0 / leaving;
    Material material = empty_material();
    material.base = reflectance;
    material.specular = specular;
    material.roughness = roughness;
    material.eta = Vec3{1, 1, 1} * static_cast<float>(eta);
    material.lobe = NEARLIGHT_LOBE_COAT;
    material.base_saturation = nonlinear ? static_cast<float>(inside) : 0.0f;
    material.base_scale = static_cast<float>(leaving * linear_factor);
    material.light_scale = static_cast<float>((1.0 - outside) * leaving * linear_factor);
    material.light_offset = specular * static_cast<float>(outside);
    return material;
}

Material conductor_material(Vec3 eta, Vec3 k, Vec3 specular, float roughness) {
    Material material = empty_material();
    material.specular = specular;
    material.roughness = roughness;
    material.eta = eta;
    material.k = k;
    material.lobe = NEARLIGHT_LOBE_CONDUCTOR;
    const Vec3 mean{static_cast<float>(mean_conductor_reflectance(eta.x, k.x)),
                    static_cast<float>(mean_conductor_reflectance(eta.y, k.y)),
                    static_cast<float>(mean_conductor_reflectance(eta.z, k.z))};
    material.light_offset = min(specular * mean, Vec3{1, 1, 1} * kMaxConductorAlbedo);
    return material;
}

Material glass_material(double eta, bool thin) {
    Material material = empty_material();
    material.eta = Vec3{1, 1, 1} * static_cast<float>(eta);
    material.lobe = thin ? NEARLIGHT_LOBE_THIN_DIELECTRIC : NEARLIGHT_LOBE_DIELECTRIC;
    return material;
}

}  // namespace nearlight::core
