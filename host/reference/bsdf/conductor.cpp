// SPDX-License-Identifier: Apache-2.0
// Metals: a mirror, or microfacets that are mirrors.
#include "host/reference/bsdf/bsdf_model.h"
#include "host/reference/bsdf/fresnel.h"

namespace nearlight::core {
namespace {

Vec3d eval_conductor(const BsdfParameters& p, Vec3d wo, Vec3d wi) {
    if (is_smooth(p) || wo.z <= 0 || wi.z <= 0) {
        return {};
    }
    const Vec3d fresnel = fresnel_of_conductor(dot(wo, half_vector(wo, wi)), p.eta, p.k);
    return p.specular * fresnel * microfacet_reflection(microfacets(p), wo, wi);
}

double pdf_conductor(const BsdfParameters& p, Vec3d wo, Vec3d wi) {
    return is_smooth(p) ? 0 : microfacet_reflection_pdf(microfacets(p), wo, wi);
}

Vec3d estimate_conductor(const BsdfParameters& p, Vec3d wo) {
    return p.specular * fresnel_of_conductor(wo.z, p.eta, p.k);
}

BsdfDraw sample_conductor(const BsdfParameters& p, Vec3d wo, BsdfRandom random) {
    if (wo.z <= 0) {
        return {};
    }
    if (is_smooth(p)) {
        return {.wi = {-wo.x, -wo.y, wo.z}, .weight = estimate_conductor(p, wo), .is_delta = true};
    }
    const Vec3d wi = mirrored(wo, microfacets(p).sample_visible(wo, random.x, random.y));
    const double pdf = pdf_conductor(p, wo, wi);
    return pdf > 0 ? BsdfDraw{.wi = wi, .weight = eval_conductor(p, wo, wi) / pdf, .pdf = pdf} : BsdfDraw{};
}

}  // namespace

const SpecularModel kConductorModel{eval_conductor, pdf_conductor, sample_conductor, estimate_conductor};

}  // namespace nearlight::core
