// SPDX-License-Identifier: Apache-2.0
// The coat of plastic: a dielectric boundary, smooth or of microfacets. The base below it is D.
#include "host/reference/bsdf/bsdf_model.h"
#include "host/reference/bsdf/fresnel.h"

namespace nearlight::core {
namespace {

Vec3d eval_plastic(const BsdfParameters& p, Vec3d wo, Vec3d wi) {
    if (is_smooth(p) || wo.z <= 0 || wi.z <= 0) {
        return {};
    }
    const double fresnel = fresnel_of_dielectric(dot(wo, half_vector(wo, wi)), p.eta.x);
    return p.specular * (fresnel * microfacet_reflection(microfacets(p), wo, wi));
}

double pdf_plastic(const BsdfParameters& p, Vec3d wo, Vec3d wi) {
    return is_smooth(p) ? 0 : microfacet_reflection_pdf(microfacets(p), wo, wi);
}

BsdfDraw sample_plastic(const BsdfParameters& p, Vec3d wo, BsdfRandom random) {
    if (wo.z <= 0) {
        return {};
    }
    if (is_smooth(p)) {
        return {.wi = {-wo.x, -wo.y, wo.z},
                .weight = p.specular * fresnel_of_dielectric(wo.z, p.eta.x),
                .is_delta = true};
    }
    const Vec3d wi = mirrored(wo, microfacets(p).sample_visible(wo, random.x, random.y));
    const double pdf = pdf_plastic(p, wo, wi);
    return pdf > 0 ? BsdfDraw{.wi = wi, .weight = eval_plastic(p, wo, wi) / pdf, .pdf = pdf} : BsdfDraw{};
}

Vec3d estimate_plastic(const BsdfParameters& p, Vec3d wo) {
    return p.specular * (is_smooth(p) ? fresnel_of_dielectric(wo.z, p.eta.x)
                                      : std::max(0.01, 1 - base_transmittance(p, wo.z)));
}

}  // namespace

const SpecularModel kPlasticModel{eval_plastic, pdf_plastic, sample_plastic, estimate_plastic};

}  // namespace nearlight::core
