// SPDX-License-Identifier: Apache-2.0
// The boundary of a glass body, smooth or rough [Walter et al., EGSR 2007].
#include "host/reference/bsdf/bsdf_model.h"
#include "host/reference/bsdf/fresnel.h"
#include "host/reference/bsdf/rough_refraction.h"

namespace nearlight::core {
namespace {

Vec3d eval_dielectric(const BsdfParameters& p, Vec3d wo, Vec3d wi) {
    if (is_smooth(p) || wo.z <= 0 || wi.z == 0) {
        return {};
    }
    const Microfacets facets = microfacets(p);
    if (wi.z > 0) {
        const double fresnel = fresnel_of_dielectric(dot(wo, half_vector(wo, wi)), p.eta.x);
        return p.specular * (fresnel * microfacet_reflection(facets, wo, wi));
    }
    const Vec3d m = refraction_normal(wo, wi, p.eta.x);
    const double fresnel = fresnel_of_dielectric(dot(wo, m), p.eta.x);
    return p.transmission * ((1 - fresnel) * microfacet_refraction(facets, wo, wi, p.eta.x));
}

double pdf_dielectric(const BsdfParameters& p, Vec3d wo, Vec3d wi) {
    if (is_smooth(p) || wo.z <= 0 || wi.z == 0) {
        return 0;
    }
    const Microfacets facets = microfacets(p);
    if (wi.z > 0) {
        return fresnel_of_dielectric(dot(wo, half_vector(wo, wi)), p.eta.x) *
               microfacet_reflection_pdf(facets, wo, wi);
    }
    const Vec3d m = refraction_normal(wo, wi, p.eta.x);
    return (1 - fresnel_of_dielectric(dot(wo, m), p.eta.x)) *
           microfacet_refraction_pdf(facets, wo, wi, p.eta.x);
}

BsdfDraw sample_smooth_dielectric(const BsdfParameters& p, Vec3d wo, double choice) {
    if (choice < fresnel_of_dielectric(wo.z, p.eta.x)) {
        return {.wi = {-wo.x, -wo.y, wo.z}, .weight = p.specular, .is_delta = true};
    }
    const Vec3d wi = refracted(wo, {0, 0, 1}, p.eta.x);
    return is_zero(wi) ? BsdfDraw{}
                       : BsdfDraw{.wi = wi, .weight = p.transmission, .eta = p.eta.x, .is_delta = true};
}

BsdfDraw sample_dielectric(const BsdfParameters& p, Vec3d wo, BsdfRandom random) {
    if (wo.z <= 0) {
        return {};
    }
    if (is_smooth(p)) {
        return sample_smooth_dielectric(p, wo, random.choice);
    }
    const Vec3d m = microfacets(p).sample_visible(wo, random.x, random.y);
    const bool reflects = random.choice < fresnel_of_dielectric(dot(wo, m), p.eta.x);
    const Vec3d wi = reflects ? mirrored(wo, m) : refracted(wo, m, p.eta.x);
    const double pdf = reflects == (wi.z > 0) ? pdf_dielectric(p, wo, wi) : 0;
    return pdf > 0 ? BsdfDraw{.wi = wi,
                              .weight = eval_dielectric(p, wo, wi) / pdf,
                              .pdf = pdf,
                              .eta = reflects ? 1 : p.eta.x}
                   : BsdfDraw{};
}

// The facets of a rough boundary lean, so that some reflect and some let through wherever the boundary as a
// whole would do one alone.
Vec3d estimate_dielectric(const BsdfParameters& p, Vec3d wo) {
    constexpr double kLeast = 0.05;
    const double fresnel = fresnel_of_dielectric(wo.z, p.eta.x);
    return mix(p.transmission, p.specular, is_smooth(p) ? fresnel : std::clamp(fresnel, kLeast, 1 - kLeast));
}

}  // namespace

const SpecularModel kDielectricModel{eval_dielectric, pdf_dielectric, sample_dielectric, estimate_dielectric};

}  // namespace nearlight::core
