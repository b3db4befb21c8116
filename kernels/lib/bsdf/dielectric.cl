// SPDX-License-Identifier: Apache-2.0
// The boundary of a glass body, smooth or rough, from either side: eta.x is the index beyond it ÷ the
// viewer's. Mitsuba's `dielectric` and `roughdielectric`. [Walter et al., Microfacet Models for Refraction,
// 2007]
#ifndef NEARLIGHT_LIB_BSDF_DIELECTRIC
#define NEARLIGHT_LIB_BSDF_DIELECTRIC

#include "lib/bsdf/microfacet.cl"
#include "lib/fresnel.cl"

/// The normal of the facet that reflects (wi.z > 0) or refracts wo into wi.
static inline float3 facet_between(float3 wo, float3 wi, float eta) {
    const float3 m = normalize(wo + (wi.z > 0.0f ? 1.0f : eta) * wi);
    return m.z < 0.0f ? -m : m;
}

/// Refraction by facets, without Fresnel's factor, for the transport of flux. `pdf` gets the density of
/// refractions at visible facets.
static inline float facet_refraction(const Microfacets* facets, float3 wo, float3 wi, float3 m, float eta,
                                     float* pdf) {
    const float cos_near = dot(wo, m);
    const float cos_far = dot(wi, m);
    *pdf = 0.0f;
    if (!(cos_near > 0.0f) || !(cos_far < 0.0f)) {
        return 0.0f;
    }
    const float denominator = cos_near + eta * cos_far;
    const float jacobian = eta * eta * -cos_far / fmax(denominator * denominator, 1e-20f);
    *pdf = facet_density(facets, m) * facet_masking(facets, wo, m) * cos_near / wo.z * jacobian;
    return *pdf * facet_masking(facets, wi, m);
}

static inline float3 dielectric_eval(const Bsdf* bsdf, float3 wo, float3 wi, float* pdf) {
    const Microfacets facets = microfacets_of(bsdf);
    const float eta = bsdf->eta.x;
    float3 m = facet_between(wo, wi, eta);
    float cos_far;
    const float reflectance = fresnel_dielectric(clamp(dot(wo, m), 0.0f, 1.0f), eta, &cos_far);
    float share = reflectance;
    float3 tint = bsdf->specular;
    float value;
    if (wi.z > 0.0f) {
        value = facet_reflection(&facets, wo, wi, &m, pdf);
    } else {
        value = facet_refraction(&facets, wo, wi, m, eta, pdf);
        share = 1.0f - reflectance;
        tint = bsdf->transmission;
    }
    *pdf *= share;
    return tint * (share * value);
}

/// Gives `sample` the mirror image of wo about the facet m. One that leaves the viewer's side is none of this
/// surface, and wi stays 0.
static inline void reflect_at(float3 wo, float3 m, BsdfSample* sample) {
    const float3 wi = mirror(wo, m);
    if (wi.z > 0.0f) {
        sample->wi = wi;
    }
}

/// Gives `sample` the refraction of wo about the facet m, and its eta. One that stays on the viewer's side is
/// none of this surface, and wi stays 0.
static inline void refract_at(float3 wo, float3 m, float cos_far, float eta, BsdfSample* sample) {
    const float3 wi = (dot(wo, m) / eta - cos_far) * m - wo / eta;
    if (wi.z < 0.0f) {
        sample->wi = normalize(wi);
        sample->eta = eta;
    }
}

/// Direction of a mirror image or a refraction about the facet m, chosen by `u`. `sample` gets a tint, too,
/// which is its weight if the facet is the surface itself.
static inline void choose_at_boundary(const Bsdf* bsdf, float3 wo, float3 m, float u, BsdfSample* sample) {
    const float cos_near = clamp(dot(wo, m), 0.0f, 1.0f);
    const float eta = bsdf->eta.x;
    float cos_far;
    if (u < fresnel_dielectric(cos_near, eta, &cos_far)) {
        reflect_at(wo, m, sample);
        sample->weight = bsdf->specular;
    } else {
        refract_at(wo, m, cos_far, eta, sample);
        sample->weight = bsdf->transmission;
    }
}

static inline BsdfSample dielectric_sample(const Bsdf* bsdf, float3 wo, float u, float2 v) {
    BsdfSample sample = no_bsdf_sample();
    sample.is_delta = is_smooth(bsdf);
    float3 m = (float3)(0.0f, 0.0f, 1.0f);
    if (!sample.is_delta) {
        const Microfacets facets = microfacets_of(bsdf);
        m = sample_visible_facet(&facets, wo, v);
    }
    choose_at_boundary(bsdf, wo, m, u, &sample);
    return sample;
}

/// The facets of a rough boundary lean, so that some reflect and some let through wherever the boundary as a
/// whole would do one alone; neither may count for nothing.
#define LEAST_FACET_SHARE 0.05f

/// The estimate is exact for a smooth boundary.
static inline float3 dielectric_albedo(const Bsdf* bsdf, float3 wo) {
    float cos_far;
    const float cosine = is_smooth(bsdf) ? wo.z : facing_cosine(bsdf, wo);
    float reflectance = fresnel_dielectric(cosine, bsdf->eta.x, &cos_far);
    if (!is_smooth(bsdf)) {
        reflectance = clamp(reflectance, LEAST_FACET_SHARE, 1.0f - LEAST_FACET_SHARE);
    }
    // Light out of the denser side meets facets a second time more often.
    const float escape = mix(1.0f, facet_escape(bsdf), bsdf->eta.x < 1.0f ? 1.0f : 0.5f);
    return escape * mix(bsdf->transmission, bsdf->specular, reflectance);
}

#endif
