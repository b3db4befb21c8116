// SPDX-License-Identifier: Apache-2.0
#include "host/reference/bsdf/principled_parts.h"

#include <numbers>

#include "host/reference/bsdf/fresnel.h"

namespace nearlight::core {

Microfacets principled_facets(double roughness, double anisotropic) {
    constexpr double kMinAlpha = 0.001;
    const double alpha = roughness * roughness;
    const double aspect = std::sqrt(1 - 0.9 * anisotropic);
    return {false, std::max(kMinAlpha, alpha / aspect), std::max(kMinAlpha, alpha * aspect)};
}

Vec3d principled_tint(Vec3d base) {
    const double luminance = dot(base, {0.212671, 0.715160, 0.072169});
    return luminance > 0 ? base / luminance : Vec3d{1, 1, 1};
}

double principled_retro(const BsdfParameters& p, Vec3d wo, Vec3d wi) {
    const double view = schlick_weight(wo.z);
    const double light = schlick_weight(wi.z);
    const double difference = dot(half_vector(wo, wi), wi);
    const double rr = 2 * p.alpha_x * difference * difference;
    const double retro = p.layered ? 0 : rr * (view + light + view * light * (rr - 1));
    if (p.flatness == 0) {
        return retro;
    }
    // Hanrahan and Krueger's subsurface scattering, isotropic and flattened.
    const double fss90 = rr / 2;
    const double fss = (1 + (fss90 - 1) * view) * (1 + (fss90 - 1) * light);
    const double flat = 1.25 * (fss * (1 / (wo.z + wi.z) - 0.5) + 0.5);
    return (1 - p.flatness) * retro + p.flatness * flat;
}

Vec3d principled_sheen(const BsdfParameters& p, Vec3d wo, Vec3d wi) {
    const double weight = p.sheen * schlick_weight(std::abs(dot(half_vector(wo, wi), wi)));
    return mix({1, 1, 1}, principled_tint(p.base), p.sheen_tint) * weight;
}

double clearcoat_alpha(double gloss) {
    return 0.1 + (0.001 - 0.1) * gloss;
}

double clearcoat_density(Vec3d m, double alpha) {
    const double a2 = alpha * alpha;
    return m.z > 0 ? (a2 - 1) / (std::numbers::pi * std::log(a2) * (1 + (a2 - 1) * m.z * m.z)) : 0;
}

Vec3d sample_clearcoat_normal(double alpha, double u, double v) {
    const double a2 = alpha * alpha;
    const double cosine2 = std::clamp((1 - std::pow(a2, 1 - u)) / (1 - a2), 0.0, 1.0);
    const double sine = std::sqrt(1 - cosine2);
    const double angle = 2 * std::numbers::pi * v;
    return {sine * std::cos(angle), sine * std::sin(angle), std::sqrt(cosine2)};
}

}  // namespace nearlight::core
