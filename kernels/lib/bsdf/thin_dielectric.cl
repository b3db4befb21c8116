// SPDX-License-Identifier: Apache-2.0
// A pane of glass, both of its faces at once: it mirrors, or lets light pass straight on. Mitsuba's
// `thindielectric`. A face of clear glass does the same, by itself: eta.x is always that of the body ÷ the
// index outside, because light that does not turn leaves the body at the angle at which it entered, and the
// reflectance of both faces is then the same.
#ifndef NEARLIGHT_LIB_BSDF_THIN_DIELECTRIC
#define NEARLIGHT_LIB_BSDF_THIN_DIELECTRIC

#include "lib/bsdf/bsdf_types.cl"
#include "lib/fresnel.cl"

/// Reflectance of the pane, with all reflections between its faces: r + t·r·t + t·r³·t + …; of clear glass,
/// r.
static inline float pane_reflectance(const Bsdf* bsdf, float3 wo) {
    float cos_far;
    const float once = fresnel_dielectric(wo.z, bsdf->eta.x, &cos_far);
    return bsdf->model == NEARLIGHT_BSDF_CLEAR_GLASS ? once : 2.0f * once / (1.0f + once);
}

static inline BsdfSample thin_dielectric_sample(const Bsdf* bsdf, float3 wo, float u) {
    BsdfSample sample = no_bsdf_sample();
    const bool reflected = u < pane_reflectance(bsdf, wo);
    sample.wi = reflected ? (float3)(-wo.xy, wo.z) : -wo;
    sample.weight = reflected ? bsdf->specular : bsdf->transmission;
    sample.is_delta = 1;
    sample.is_straight = !reflected;
    return sample;
}

static inline float3 thin_dielectric_albedo(const Bsdf* bsdf, float3 wo) {
    return mix(bsdf->transmission, bsdf->specular, pane_reflectance(bsdf, wo));
}

#endif
