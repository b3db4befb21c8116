// SPDX-License-Identifier: Apache-2.0
// The principled model of solid bodies, without the Lambertian part of its base: microfacets that reflect and
// refract, clearcoat, retro-reflection, flat subsurface scattering and sheen.
#include <numbers>

#include "host/reference/bsdf/bsdf_model.h"
#include "host/reference/bsdf/fresnel.h"
#include "host/reference/bsdf/principled_parts.h"
#include "host/reference/bsdf/rough_refraction.h"

namespace nearlight::core {
namespace {

/// Share of the base that reflects diffusely, and share of light that goes through.
double base_share(const BsdfParameters& p) {
    return (1 - p.metallic) * (1 - p.spec_trans);
}
double glass_share(const BsdfParameters& p) {
    return (1 - p.metallic) * p.spec_trans;
}

/// The reflectance of microfacets: of a dielectric, whose tint and metallic share follow Schlick.
Vec3d facet_reflectance(const BsdfParameters& p, double cosine) {
    const double eta = p.eta.x;
    const double dielectric = fresnel_of_dielectric(cosine, eta);
    if (!p.front) {
        return Vec3d{1, 1, 1} * (glass_share(p) * dielectric);
    }
    const double r0 = (eta - 1) / (eta + 1);
    const Vec3d metal = schlick_reflectance(p.base, cosine, eta);
    const Vec3d tinted = schlick_reflectance(principled_tint(p.base) * (r0 * r0), cosine, eta);
    const Vec3d uncoloured = Vec3d{1, 1, 1} * dielectric;
    return metal * p.metallic + mix(uncoloured, tinted, p.spec_tint) * (1 - p.metallic);
}

double clearcoat_of(const BsdfParameters& p, Vec3d wo, Vec3d wi) {
    const Vec3d m = half_vector(wo, wi);
    const Microfacets shadowing(false, 0.25, 0.25);
    const double fresnel = schlick_reflectance({0.04, 0.04, 0.04}, dot(wo, m), p.eta.x).x;
    return 0.25 * p.clearcoat * fresnel * clearcoat_density(m, clearcoat_alpha(p.clearcoat_gloss)) *
           shadowing.masking(wo, wi, m) * wi.z;
}

Vec3d eval_principled(const BsdfParameters& p, Vec3d wo, Vec3d wi) {
    if (wo.z <= 0 || wi.z == 0) {
        return {};
    }
    const Microfacets facets = principled_facets(p.alpha_x, p.anisotropic);
    if (wi.z < 0) {
        if (glass_share(p) == 0) {
            return {};
        }
        const double fresnel = fresnel_of_dielectric(dot(wo, refraction_normal(wo, wi, p.eta.x)), p.eta.x);
        const Vec3d tint{std::sqrt(p.base.x), std::sqrt(p.base.y), std::sqrt(p.base.z)};
        return tint * (glass_share(p) * (1 - fresnel) * microfacet_refraction(facets, wo, wi, p.eta.x));
    }
    const double cosine = dot(wo, half_vector(wo, wi));
    // Where nothing is reflected as by a dielectric, Mitsuba leaves the metal's part out too.
    Vec3d value;
    if (fresnel_of_dielectric(cosine, p.eta.x) > 0) {
        value = facet_reflectance(p, cosine) * microfacet_reflection(facets, wo, wi);
    }
    if (p.front) {
        value += Vec3d{1, 1, 1} * clearcoat_of(p, wo, wi);
        value += p.base * (base_share(p) * principled_retro(p, wo, wi) * wi.z / std::numbers::pi);
        value += principled_sheen(p, wo, wi) * ((1 - p.metallic) * wi.z);
    }
    return value;
}

/// The lobes that directions are drawn from.
struct PrincipledChances {
    double facets, clearcoat, cosine;
};

PrincipledChances principled_chances(const BsdfParameters& p, Vec3d wo) {
    if (!p.front) {
        return {1, 0, 0};
    }
    const double facets =
        std::max(0.02, max_component(facet_reflectance(p, wo.z))) + glass_share(p) * max_component(p.base);
    const double clearcoat = 0.25 * p.clearcoat;
    const double cosine = base_share(p) * max_component(p.base) * (0.25 * p.alpha_x + p.flatness) +
                          0.5 * p.sheen * (1 - p.metallic);
    const double sum = facets + clearcoat + cosine;
    return {facets / sum, clearcoat / sum, cosine / sum};
}

/// Probability with which a microfacet that shows the cosine to the viewer reflects.
double reflection_chance(const BsdfParameters& p, double cosine) {
    const double fresnel = fresnel_of_dielectric(cosine, p.eta.x);
    return p.front ? 1 - glass_share(p) * (1 - fresnel) : fresnel;
}

double pdf_principled(const BsdfParameters& p, Vec3d wo, Vec3d wi) {
    if (wo.z <= 0 || wi.z == 0 || (!p.front && glass_share(p) == 0)) {
        return 0;
    }
    const PrincipledChances chances = principled_chances(p, wo);
    const Microfacets facets = principled_facets(p.alpha_x, p.anisotropic);
    if (wi.z < 0) {
        const double reflects = reflection_chance(p, dot(wo, refraction_normal(wo, wi, p.eta.x)));
        return chances.facets * (1 - reflects) * microfacet_refraction_pdf(facets, wo, wi, p.eta.x);
    }
    const Vec3d m = half_vector(wo, wi);
    return chances.facets * reflection_chance(p, dot(wo, m)) * microfacet_reflection_pdf(facets, wo, wi) +
           chances.clearcoat * clearcoat_density(m, clearcoat_alpha(p.clearcoat_gloss)) * m.z /
               (4 * dot(wo, m)) +
           chances.cosine * cosine_pdf(wi);
}

BsdfDraw sample_principled(const BsdfParameters& p, Vec3d wo, BsdfRandom random) {
    if (wo.z <= 0 || (!p.front && glass_share(p) == 0)) {
        return {};
    }
    const PrincipledChances chances = principled_chances(p, wo);
    BsdfDraw draw;
    if (random.choice < chances.facets) {
        const Vec3d m = principled_facets(p.alpha_x, p.anisotropic).sample_visible(wo, random.x, random.y);
        const bool reflects = random.choice / chances.facets < reflection_chance(p, dot(wo, m));
        draw.wi = reflects ? mirrored(wo, m) : refracted(wo, m, p.eta.x);
        draw.eta = reflects ? 1 : p.eta.x;
        if (reflects != (draw.wi.z > 0)) {
            return {};
        }
    } else if (random.choice < chances.facets + chances.clearcoat) {
        const Vec3d m = sample_clearcoat_normal(clearcoat_alpha(p.clearcoat_gloss), random.x, random.y);
        draw.wi = mirrored(wo, m);
        if (dot(wo, m) <= 0 || draw.wi.z <= 0) {
            return {};
        }
    } else {
        draw.wi = sample_cosine(random.x, random.y);
    }
    draw.pdf = pdf_principled(p, wo, draw.wi);
    if (!(draw.pdf > 0)) {
        return {};
    }
    draw.weight = eval_principled(p, wo, draw.wi) / draw.pdf;
    return draw;
}

Vec3d estimate_principled(const BsdfParameters& p, Vec3d wo) {
    if (!p.front) {
        return Vec3d{1, 1, 1} * glass_share(p);
    }
    return facet_reflectance(p, wo.z) + p.base * glass_share(p) +
           Vec3d{1, 1, 1} * (0.02 + 0.02 * p.clearcoat + 0.3 * p.sheen * (1 - p.metallic)) +
           p.base * (base_share(p) * (0.1 * p.alpha_x + p.flatness));
}

}  // namespace

const SpecularModel kPrincipledModel{eval_principled, pdf_principled, sample_principled, estimate_principled};

}  // namespace nearlight::core
