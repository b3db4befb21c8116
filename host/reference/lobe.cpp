// SPDX-License-Identifier: Apache-2.0
#include "host/reference/lobe.h"

namespace nearlight::core {
namespace {

constexpr float kSmooth = 1e-3f;

/// The microfacet at which a lobe reflects or refracts, and the masking of the outgoing direction.
struct Facet {
    Vec3 normal;
    Frame frame;
    float alpha;

    [[nodiscard]] float masking(Vec3 direction) const {
        return alpha < kSmooth ? 1.0f : ggx_masking(frame.to_local(direction), alpha);
    }
};

Facet sample_facet(Vec3 normal, float alpha, Vec3 to_viewer, Point2 u) {
    const Frame frame(normal);
    if (alpha < kSmooth) {
        return {normal, frame, alpha};
    }
    return {frame.to_world(sample_ggx_visible_normal(frame.to_local(to_viewer), alpha, u)), frame, alpha};
}

/// The reflection on the facet. Its weight is 0 if its direction points into the surface.
LobeSample reflected(const Surface& surface, const Facet& facet, Vec3 normal, Vec3 to_viewer, Vec3 weight) {
    const Vec3 direction = normalize(reflect(to_viewer, facet.normal));
    if (dot(direction, normal) <= 0.0f || dot(direction, surface.geometric_normal) <= 0.0f) {
        return {};
    }
    return {.weight = weight * facet.masking(direction), .direction = direction};
}

LobeSample sample_coat(const Surface& surface, Vec3 normal, Vec3 to_viewer, LobeRandom random) {
    const Material& material = *surface.material;
    const float chance = fresnel_dielectric(dot(normal, to_viewer), material.eta.x);
    if (random.choice >= chance) {
        return {.is_base = true, .weight = {1, 1, 1}};  // (1 − F) divided by its probability, 1 − F
    }
    const Facet facet = sample_facet(normal, material.roughness, to_viewer, random.direction);
    const float fresnel = fresnel_dielectric(std::max(0.0f, dot(facet.normal, to_viewer)), material.eta.x);
    return reflected(surface, facet, normal, to_viewer, material.specular * (fresnel / chance));
}

LobeSample sample_conductor(const Surface& surface, Vec3 normal, Vec3 to_viewer, LobeRandom random) {
    const Material& material = *surface.material;
    const Facet facet = sample_facet(normal, material.roughness, to_viewer, random.direction);
    const Vec3 fresnel = fresnel_conductor(dot(facet.normal, to_viewer), material.eta, material.k);
    return reflected(surface, facet, normal, to_viewer, material.specular * fresnel);
}

LobeSample sample_dielectric(const Surface& surface, Vec3 normal, Vec3 to_viewer, LobeRandom random) {
    const Material& material = *surface.material;
    const float eta = surface.front ? material.eta.x : 1.0f / material.eta.x;
    const Facet facet = sample_facet(normal, material.roughness, to_viewer, random.direction);
    const float chance = fresnel_dielectric(std::clamp(dot(facet.normal, to_viewer), 0.0f, 1.0f), eta);
    if (random.choice < chance) {
        return reflected(surface, facet, normal, to_viewer, material.specular);
    }
    const Vec3 direction = refract(to_viewer, facet.normal, eta);
    if (dot(direction, normal) >= 0.0f || dot(direction, surface.geometric_normal) >= 0.0f) {
        return {};
    }
    return {.weight = material.transmission * facet.masking(direction), .direction = direction};
}

/// A thin pane, which reflects back and forth between its faces: R + T²R + T²R³ + … = 2R/(1 + R).
LobeSample sample_thin_dielectric(const Surface& surface, Vec3 normal, Vec3 to_viewer, LobeRandom random) {
    const Material& material = *surface.material;
    const float face = fresnel_dielectric(std::min(1.0f, dot(normal, to_viewer)), material.eta.x);
    if (random.choice < 2.0f * face / (1.0f + face)) {
        return reflected(surface, sample_facet(normal, 0.0f, to_viewer, {}), normal, to_viewer,
                         material.specular);
    }
    return {.weight = material.transmission, .direction = -to_viewer};
}

}  // namespace

LobeSample sample_lobe(const Surface& surface, Vec3 to_viewer, LobeRandom random) {
    // A shading normal that turns away from the viewer would reflect what lies behind the surface.
    const bool faces_viewer = dot(surface.shading_normal, to_viewer) > 1e-4f;
    const Vec3 normal = faces_viewer ? surface.shading_normal : surface.geometric_normal;
    switch (surface.material->lobe) {
        case NEARLIGHT_LOBE_COAT:
            return sample_coat(surface, normal, to_viewer, random);
        case NEARLIGHT_LOBE_CONDUCTOR:
            return sample_conductor(surface, normal, to_viewer, random);
        case NEARLIGHT_LOBE_DIELECTRIC:
            return sample_dielectric(surface, normal, to_viewer, random);
        case NEARLIGHT_LOBE_THIN_DIELECTRIC:
            return sample_thin_dielectric(surface, normal, to_viewer, random);
        default:
            return {.is_base = true, .weight = {1, 1, 1}};
    }
}

}  // namespace nearlight::core
