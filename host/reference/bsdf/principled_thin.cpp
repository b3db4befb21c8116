// SPDX-License-Identifier: Apache-2.0
// The principled model of thin sheets, without the Lambertian part that it reflects: both sides are alike,
// and light that goes through is not bent.
#include <numbers>

#include "host/reference/bsdf/bsdf_model.h"
#include "host/reference/bsdf/fresnel.h"
#include "host/reference/bsdf/principled_parts.h"

namespace nearlight::core {
namespace {

/// Microfacets of what goes through are rougher or smoother with the index [Burley 2015, figure 15].
Microfacets thin_transmission_facets(const BsdfParameters& p) {
    return principled_facets((0.65 * p.eta.x - 0.35) * p.alpha_x, p.anisotropic);
}

Vec3d upward(Vec3d w) {
    return {w.x, w.y, std::abs(w.z)};
}

double thin_base_share(const BsdfParameters& p) {
    return (1 - p.spec_trans) * (1 - p.transmission.x);
}

Vec3d thin_reflectance(const BsdfParameters& p, double cosine) {
    const double r0 = (p.eta.x - 1) / (p.eta.x + 1);
    const Vec3d tinted = schlick_reflectance(principled_tint(p.base) * (r0 * r0), cosine, p.eta.x);
    return mix(Vec3d{1, 1, 1} * fresnel_of_dielectric(cosine, p.eta.x), tinted, p.spec_tint);
}

Vec3d eval_thin_through(const BsdfParameters& p, Vec3d wo, Vec3d wi) {
    Vec3d value = p.base * ((1 - p.spec_trans) * p.transmission.x * -wi.z / std::numbers::pi);
    const Vec3d m = half_vector(wo, upward(wi));
    if (p.spec_trans > 0 && dot(wi, m) < 0) {
        const Microfacets facets = thin_transmission_facets(p);
        const double through = 1 - fresnel_of_dielectric(dot(wo, m), p.eta.x);
        value +=
            p.base * (p.spec_trans * through * facets.density(m) * facets.masking(wo, wi, m) / (4 * wo.z));
    }
    return value;
}

Vec3d eval_thin(const BsdfParameters& p, Vec3d wo, Vec3d wi) {
    if (wo.z <= 0 || wi.z == 0) {
        return {};
    }
    if (wi.z < 0) {
        return eval_thin_through(p, wo, wi);
    }
    const Microfacets facets = principled_facets(p.alpha_x, p.anisotropic);
    const Vec3d base =
        p.base * (principled_retro(p, wo, wi) / std::numbers::pi) + principled_sheen(p, wo, wi);
    return thin_reflectance(p, dot(wo, half_vector(wo, wi))) *
               (p.spec_trans * microfacet_reflection(facets, wo, wi)) +
           base * (thin_base_share(p) * wi.z);
}

/// The lobes that directions are drawn from: microfacets and cosine, on this side and through.
struct ThinChances {
    double reflection, transmission, cosine, cosine_through;
};

ThinChances thin_chances(const BsdfParameters& p) {
    const double base = max_component(p.base);
    const double reflection = 0.5 * p.spec_trans;
    const double cosine = thin_base_share(p) * (base * (0.25 * p.alpha_x + p.flatness) + 0.5 * p.sheen);
    const double cosine_through = base * (1 - p.spec_trans) * p.transmission.x;
    const double sum = 2 * reflection + cosine + cosine_through;
    if (!(sum > 0)) {
        return {0, 0, 0, 0};
    }
    return {reflection / sum, reflection / sum, cosine / sum, cosine_through / sum};
}

double pdf_thin(const BsdfParameters& p, Vec3d wo, Vec3d wi) {
    if (wo.z <= 0 || wi.z == 0) {
        return 0;
    }
    const ThinChances chances = thin_chances(p);
    if (wi.z > 0) {
        return chances.reflection *
                   microfacet_reflection_pdf(principled_facets(p.alpha_x, p.anisotropic), wo, wi) +
               chances.cosine * cosine_pdf(wi);
    }
    return chances.transmission * microfacet_reflection_pdf(thin_transmission_facets(p), wo, upward(wi)) +
           chances.cosine_through * cosine_pdf(-wi);
}

BsdfDraw sample_thin(const BsdfParameters& p, Vec3d wo, BsdfRandom random) {
    const ThinChances chances = thin_chances(p);
    if (wo.z <= 0 || chances.reflection + chances.cosine + chances.cosine_through == 0) {
        return {};
    }
    BsdfDraw draw;
    if (random.choice < chances.reflection + chances.transmission) {
        const bool through = random.choice >= chances.reflection;
        const Microfacets facets =
            through ? thin_transmission_facets(p) : principled_facets(p.alpha_x, p.anisotropic);
        draw.wi = mirrored(wo, facets.sample_visible(wo, random.x, random.y));
        if (draw.wi.z <= 0) {
            return {};
        }
        draw.wi.z = through ? -draw.wi.z : draw.wi.z;
    } else {
        const bool through = random.choice >= 1 - chances.cosine_through;
        draw.wi = sample_cosine(random.x, random.y);
        draw.wi.z = through ? -draw.wi.z : draw.wi.z;
    }
    draw.pdf = pdf_thin(p, wo, draw.wi);
    if (!(draw.pdf > 0)) {
        return {};
    }
    draw.weight = eval_thin(p, wo, draw.wi) / draw.pdf;
    return draw;
}

Vec3d estimate_thin(const BsdfParameters& p, Vec3d wo) {
    const Vec3d glass = mix(p.base, {1, 1, 1}, fresnel_of_dielectric(wo.z, p.eta.x));
    return glass * p.spec_trans + p.base * ((1 - p.spec_trans) * p.transmission.x) +
           (p.base * (0.1 * p.alpha_x + p.flatness) + Vec3d{0.3, 0.3, 0.3} * p.sheen) * thin_base_share(p);
}

}  // namespace

const SpecularModel kPrincipledThinModel{eval_thin, pdf_thin, sample_thin, estimate_thin};

}  // namespace nearlight::core
