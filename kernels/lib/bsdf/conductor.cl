// SPDX-License-Identifier: Apache-2.0
// Metal, smooth or rough. Mitsuba's `conductor` and `roughconductor`.
#ifndef NEARLIGHT_LIB_BSDF_CONDUCTOR
#define NEARLIGHT_LIB_BSDF_CONDUCTOR

#include "lib/bsdf/microfacet.cl"
#include "lib/fresnel.cl"

static inline float3 conductor_eval(const Bsdf* bsdf, float3 wo, float3 wi, float* pdf) {
    float3 m;
    const Microfacets facets = microfacets_of(bsdf);
    const float reflection = facet_reflection(&facets, wo, wi, &m, pdf);
    return bsdf->specular * fresnel_conductor(clamp(dot(wo, m), 0.0f, 1.0f), bsdf->eta, bsdf->k) * reflection;
}

static inline BsdfSample conductor_sample(const Bsdf* bsdf, float3 wo, float2 v) {
    BsdfSample sample = no_bsdf_sample();
    if (is_smooth(bsdf)) {
        sample.wi = (float3)(-wo.xy, wo.z);
        sample.weight = bsdf->specular * fresnel_conductor(wo.z, bsdf->eta, bsdf->k);
        sample.is_delta = 1;
        return sample;
    }
    const Microfacets facets = microfacets_of(bsdf);
    sample.wi = mirror(wo, sample_visible_facet(&facets, wo, v));
    return sample;
}

/// The estimate is exact for smooth metal.
static inline float3 conductor_albedo(const Bsdf* bsdf, float3 wo) {
    const float cosine = is_smooth(bsdf) ? wo.z : facing_cosine(bsdf, wo);
    return bsdf->specular * facet_escape(bsdf) * fresnel_conductor(cosine, bsdf->eta, bsdf->k);
}

#endif
