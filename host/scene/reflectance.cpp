// SPDX-License-Identifier: Apache-2.0
#include "host/scene/reflectance.h"

#include <algorithm>
#include <span>

#include "host/scene/material_model.h"
#include "host/scene/transmission_curve.h"

namespace nearlight::core {
namespace {

const Material& child(const Scene& scene, const Material& material, std::size_t index) {
    return scene.materials[material.child[index]];
}

/// Whether `test` holds for the material or any that it stands for, directly or not.
template <typename Test>
bool any_of_tree(const Scene& scene, const Material& material, const Test& test) {
    return test(material) || std::ranges::any_of(children(material), [&](uint index) {
               return any_of_tree(scene, scene.materials[index], test);
           });
}

/// The expectation of estimate(material) over the materials that one stands for; `through` is that of a hole.
template <typename Estimate>
Vec3 expectation(const Scene& scene, const Material& material, float u, float v, Vec3 vertex_color,
                 Vec3 through, const Estimate& estimate) {
    if (!stands_for_others(material)) {
        return estimate(material);
    }
    const auto of_child = [&](std::size_t index) {
        return expectation(scene, child(scene, material, index), u, v, vertex_color, through, estimate);
    };
    const float weight =
        std::clamp(parameter_number(scene, material.reflectance, u, v, vertex_color), 0.0f, 1.0f);
    if (material.model == NEARLIGHT_BSDF_MASK) {
        return of_child(0) * weight + through * (1.0f - weight);
    }
    return material.model == NEARLIGHT_BSDF_BLEND ? of_child(0) * (1.0f - weight) + of_child(1) * weight
                                                  : of_child(0);
}

float mean_of_curve(const Scene& scene, uint curve) {
    return mean_transmission(std::span(scene.transmission_curves)
                                 .subspan(std::size_t{curve} * NEARLIGHT_CURVE_SIZE, NEARLIGHT_CURVE_SIZE));
}

/// The parameters of one material at a point.
struct Point {
    const Scene& scene;
    const Material& material;
    float u, v;
    Vec3 vertex_color;

    [[nodiscard]] Vec3 color(const Parameter& parameter) const {
        return parameter_value(scene, parameter, u, v, vertex_color);
    }
    [[nodiscard]] float number(const Parameter& parameter) const {
        return std::clamp(parameter_number(scene, parameter, u, v, vertex_color), 0.0f, 1.0f);
    }
};

/// Whether the material is Lambertian with a lobe of gloss beside it, which takes nothing from it.
bool has_lobe_beside_base(const Material& m) {
    return m.model == NEARLIGHT_BSDF_PHONG || m.model == NEARLIGHT_BSDF_WARD;
}

/// The colour of D below its curve.
Vec3 base_color(const Point& at) {
    const Material& m = at.material;
    const Vec3 rho = at.color(m.reflectance);
    if (m.model == NEARLIGHT_BSDF_DIFFUSE || has_lobe_beside_base(m)) {
        return rho;
    }
    if (m.model == NEARLIGHT_BSDF_PRINCIPLED) {
        const float thin_share = (m.flags & NEARLIGHT_MATERIAL_THIN) != 0 ? 1.0f : 0.0f;
        return rho * ((1.0f - at.number(m.metallic)) * (1.0f - at.number(m.spec_trans)) *
                      (1.0f - thin_share * std::clamp(at.color(m.transmission).x, 0.0f, 1.0f)));
    }
    if (m.model != NEARLIGHT_BSDF_PLASTIC) {
        return {0, 0, 0};
    }
    const bool saturates = (m.flags & NEARLIGHT_MATERIAL_NONLINEAR) != 0;
    const auto channel = [&](float x) {
        return x /
               ((1.0f - m.internal_reflectance * (saturates ? std::min(x, 1.0f) : 1.0f)) * m.eta.x * m.eta.x);
    };
    return {channel(rho.x), channel(rho.y), channel(rho.z)};
}

Vec3 base_albedo(const Point& at) {
    const float transmission = mean_of_curve(at.scene, at.material.curve);
    return base_color(at) * (transmission * transmission);
}

Vec3 mean_metal(const Material& m) {
    const auto channel = [](float eta, float k) {
        return static_cast<float>(
            mean_conductor_reflectance(static_cast<double>(eta), static_cast<double>(k)));
    };
    return {channel(m.eta.x, m.k.x), channel(m.eta.y, m.k.y), channel(m.eta.z, m.k.z)};
}

Vec3 total_reflectance(const Point& at) {
    const Material& m = at.material;
    switch (m.model) {
        case NEARLIGHT_BSDF_PLASTIC:
            return base_albedo(at) + at.color(m.specular) * (1.0f - mean_of_curve(at.scene, m.curve));
        case NEARLIGHT_BSDF_CONDUCTOR:
            return at.color(m.specular) * mean_metal(m);
        case NEARLIGHT_BSDF_PHONG:  // a narrow lobe reflects the cosine of its direction
            return base_albedo(at) + at.color(m.specular) * (2.0f / 3.0f);
        case NEARLIGHT_BSDF_WARD:
            return base_albedo(at) + at.color(m.specular);
        case NEARLIGHT_BSDF_DIELECTRIC:
        case NEARLIGHT_BSDF_THIN_DIELECTRIC: {
            const auto reflected = static_cast<float>(
                mean_dielectric_reflectance(static_cast<double>(std::max(m.eta.x, 1.0f / m.eta.x))));
            const float share =
                m.model == NEARLIGHT_BSDF_DIELECTRIC ? reflected : 2.0f * reflected / (1.0f + reflected);
            return at.color(m.specular) * share + at.color(m.transmission) * (1.0f - share);
        }
        case NEARLIGHT_BSDF_PRINCIPLED:
            return at.color(m.reflectance);  // metal, glass and base all have this colour
        case NEARLIGHT_BSDF_NULL:
            return {1, 1, 1};
        default:
            return base_albedo(at);
    }
}

/// Whether the parameter may be above 0 somewhere.
bool may_be_positive(const Parameter& parameter) {
    return max_component(parameter.value) > 0.0f;
}

}  // namespace

Vec3 diffuse_albedo(const Scene& scene, const Material& material, float u, float v, Vec3 vertex_color) {
    return expectation(scene, material, u, v, vertex_color, {0, 0, 0}, [&](const Material& m) {
        return base_albedo({scene, m, u, v, vertex_color});
    });
}

Vec3 mean_reflectance(const Scene& scene, const Material& material, float u, float v, Vec3 vertex_color) {
    return expectation(scene, material, u, v, vertex_color, {1, 1, 1}, [&](const Material& m) {
        return total_reflectance({scene, m, u, v, vertex_color});
    });
}

bool has_diffuse(const Scene& scene, const Material& material) {
    return any_of_tree(scene, material, [](const Material& m) {
        return m.model == NEARLIGHT_BSDF_DIFFUSE || m.model == NEARLIGHT_BSDF_PLASTIC ||
               m.model == NEARLIGHT_BSDF_PRINCIPLED || has_lobe_beside_base(m);
    });
}

bool has_specular(const Scene& scene, const Material& material) {
    return any_of_tree(scene, material, [](const Material& m) {
        return m.model == NEARLIGHT_BSDF_MASK || (!stands_for_others(m) && m.model != NEARLIGHT_BSDF_DIFFUSE);
    });
}

bool has_rough_gloss(const Scene& scene, const Material& material) {
    return any_of_tree(scene, material, [](const Material& m) {
        const bool is_coat_or_metal =
            m.model == NEARLIGHT_BSDF_PLASTIC || m.model == NEARLIGHT_BSDF_CONDUCTOR;
        return m.model == NEARLIGHT_BSDF_PRINCIPLED || has_lobe_beside_base(m) ||
               (is_coat_or_metal && max_component(m.roughness.value) >= NEARLIGHT_MIN_ALPHA);
    });
}

bool has_mirror(const Scene& scene, const Material& material) {
    return any_of_tree(scene, material, [](const Material& m) {
        const bool may_be_smooth = m.roughness.texture >= 0 ||
                                   std::min(m.roughness.value.x, m.roughness.value.y) < NEARLIGHT_MIN_ALPHA;
        return m.model == NEARLIGHT_BSDF_DIELECTRIC || (m.model == NEARLIGHT_BSDF_CONDUCTOR && may_be_smooth);
    });
}

bool reflects_back(const Scene& scene, const Material& material) {
    return lets_through(scene, material) || any_of_tree(scene, material, [](const Material& m) {
               return m.model == NEARLIGHT_BSDF_TWO_SIDED;
           });
}

bool passes_straight(const Scene& scene, const Material& material) {
    return any_of_tree(scene, material, [](const Material& m) {
        return m.model == NEARLIGHT_BSDF_THIN_DIELECTRIC || m.model == NEARLIGHT_BSDF_NULL ||
               m.model == NEARLIGHT_BSDF_MASK;
    });
}

bool is_veil(const Scene& scene, const Material& material) {
    return scene.clear_glass ? lets_through(scene, material) : passes_straight(scene, material);
}

uint veils_of(const Scene& scene) {
    if (std::ranges::none_of(scene.materials, [&](const Material& m) { return is_veil(scene, m); })) {
        return NEARLIGHT_VEILS_NONE;
    }
    return scene.clear_glass  ? NEARLIGHT_VEILS_CLEAR
           : scene.open_veils ? NEARLIGHT_VEILS_OPEN
                              : NEARLIGHT_VEILS_THIN;
}

bool lets_through(const Scene& scene, const Material& material) {
    return passes_straight(scene, material) || any_of_tree(scene, material, [](const Material& m) {
               return m.model == NEARLIGHT_BSDF_DIELECTRIC ||
                      (m.model == NEARLIGHT_BSDF_PRINCIPLED &&
                       ((m.flags & NEARLIGHT_MATERIAL_THIN) != 0 || may_be_positive(m.spec_trans)));
           });
}

}  // namespace nearlight::core
