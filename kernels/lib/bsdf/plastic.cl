// SPDX-License-Identifier: Apache-2.0
// The dielectric coat of plastic, smooth or rough, seen from outside. Its Lambertian base is the BSDF's D
// (bsdf.cl), so S reflects only. Mitsuba's `plastic` and `roughplastic`.
#ifndef NEARLIGHT_LIB_BSDF_PLASTIC
#define NEARLIGHT_LIB_BSDF_PLASTIC

#include "lib/bsdf/microfacet.cl"
#include "lib/fresnel.cl"

static inline float3 plastic_eval(const Bsdf* bsdf, float3 wo, float3 wi, float* pdf) {
    float3 m;
    float cos_far;
    const Microfacets facets = microfacets_of(bsdf);
    const float reflection = facet_reflection(&facets, wo, wi, &m, pdf);
    return bsdf->specular *
           (reflection * fresnel_dielectric(clamp(dot(wo, m), 0.0f, 1.0f), bsdf->eta.x, &cos_far));
}

static inline BsdfSample plastic_sample(const Bsdf* bsdf, float3 wo, float2 v) {
    BsdfSample sample = no_bsdf_sample();
    if (is_smooth(bsdf)) {
        float cos_far;
        sample.wi = (float3)(-wo.xy, wo.z);
        sample.weight = bsdf->specular * fresnel_dielectric(wo.z, bsdf->eta.x, &cos_far);
        sample.is_delta = 1;
        return sample;
    }
    const Microfacets facets = microfacets_of(bsdf);
    sample.wi = mirror(wo, sample_visible_facet(&facets, wo, v));
    return sample;
}

/// The estimate is exact for a smooth coat.
static inline float3 plastic_albedo(const Bsdf* bsdf, float3 wo) {
    float cos_far;
    const float cosine = is_smooth(bsdf) ? wo.z : facing_cosine(bsdf, wo);
    return bsdf->specular * facet_escape(bsdf) * fresnel_dielectric(cosine, bsdf->eta.x, &cos_far);
}

#endif
