// SPDX-License-Identifier: Apache-2.0
#include "host/reference/bsdf/bsdf_model.h"

#include <numbers>

#include "host/reference/bsdf/fresnel.h"

namespace nearlight::core {
namespace {

/// Linear interpolation between values at equidistant cosines from 0 to 1.
double interpolated(std::span<const float> curve, double cosine) {
    const double place = std::clamp(cosine, 0.0, 1.0) * static_cast<double>(curve.size() - 1);
    const auto index = std::min(static_cast<std::size_t>(place), curve.size() - 2);
    const double part = place - static_cast<double>(index);
    return curve[index] * (1 - part) + curve[index + 1] * part;
}

}  // namespace

const SpecularModel* specular_model(const BsdfParameters& parameters) {
    switch (parameters.model) {
        case NEARLIGHT_BSDF_PLASTIC:
            return &kPlasticModel;
        case NEARLIGHT_BSDF_CONDUCTOR:
            return &kConductorModel;
        case NEARLIGHT_BSDF_DIELECTRIC:
            return &kDielectricModel;
        case NEARLIGHT_BSDF_THIN_DIELECTRIC:
        case NEARLIGHT_BSDF_CLEAR_GLASS:
            return &kThinDielectricModel;
        case NEARLIGHT_BSDF_PRINCIPLED:
            return parameters.thin ? &kPrincipledThinModel : &kPrincipledModel;
        case NEARLIGHT_BSDF_NULL:
            return &kNullModel;
        case NEARLIGHT_BSDF_PHONG:
            return &kPhongModel;
        case NEARLIGHT_BSDF_WARD:
            return &kWardModel;
        default:
            return nullptr;
    }
}

double base_transmittance(const BsdfParameters& parameters, double cosine) {
    switch (parameters.model) {
        case NEARLIGHT_BSDF_PLASTIC:
            return is_smooth(parameters) ? 1 - fresnel_of_dielectric(cosine, parameters.eta.x)
                                         : interpolated(parameters.curve, cosine);
        case NEARLIGHT_BSDF_PRINCIPLED:  // [Burley 2012, section 5.3], without retro-reflection
            return parameters.layered ? interpolated(parameters.curve, cosine)
                                      : 1 - 0.5 * schlick_weight(cosine);
        default:
            return 1;
    }
}

Vec3d eval_diffuse(const BsdfParameters& parameters, Vec3d wo, Vec3d wi) {
    if (wo.z <= 0 || wi.z <= 0 || is_zero(parameters.diffuse)) {
        return {};
    }
    return parameters.diffuse * (base_transmittance(parameters, wo.z) * base_transmittance(parameters, wi.z) *
                                 wi.z / std::numbers::pi);
}

bool is_smooth(const BsdfParameters& parameters) {
    return std::max(parameters.alpha_x, parameters.alpha_y) < NEARLIGHT_MIN_ALPHA;
}

Microfacets microfacets(const BsdfParameters& parameters) {
    return {parameters.beckmann, parameters.alpha_x, parameters.alpha_y};
}

double microfacet_reflection(const Microfacets& facets, Vec3d wo, Vec3d wi) {
    if (wo.z <= 0 || wi.z <= 0) {
        return 0;
    }
    const Vec3d m = half_vector(wo, wi);
    return facets.density(m) * facets.masking(wo, wi, m) / (4 * wo.z);
}

double microfacet_reflection_pdf(const Microfacets& facets, Vec3d wo, Vec3d wi) {
    if (wo.z <= 0 || wi.z <= 0) {
        return 0;
    }
    const Vec3d m = half_vector(wo, wi);
    return facets.visible_density(wo, m) / (4 * dot(wo, m));
}

Vec3d sample_cosine(double u, double v) {
    const double radius = std::sqrt(u);
    const double angle = 2 * std::numbers::pi * v;
    return {radius * std::cos(angle), radius * std::sin(angle), std::sqrt(std::max(0.0, 1 - u))};
}

double cosine_pdf(Vec3d w) {
    return std::max(0.0, w.z) / std::numbers::pi;
}

}  // namespace nearlight::core
