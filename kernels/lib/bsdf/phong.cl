// SPDX-License-Identifier: Apache-2.0
// The lobe of the modified Phong model: a power of the cosine between wi and the mirror image of wo. Its
// Lambertian part is the BSDF's D (bsdf.cl). Mitsuba 0.6's `phong`. [Lafortune & Willems, Using the Modified
// Phong Reflectance Model for Physically Based Rendering, 1994]
#ifndef NEARLIGHT_LIB_BSDF_PHONG
#define NEARLIGHT_LIB_BSDF_PHONG

#include "lib/bsdf/bsdf_types.cl"
#include "lib/sampling.cl"

/// The power n of the cosine, from the roughness α = √(2/(n + 2)) by which materials keep it.
static inline float phong_exponent(const Bsdf* bsdf) {
    const float alpha = clamp(bsdf->alpha.x, NEARLIGHT_MIN_ALPHA, 1.0f);
    return 2.0f / (alpha * alpha) - 2.0f;
}

static inline float3 phong_eval(const Bsdf* bsdf, float3 wo, float3 wi, float* pdf) {
    const float cosine = dot(wi, (float3)(-wo.xy, wo.z));
    *pdf = 0.0f;
    if (!(wi.z > 0.0f) || !(cosine > 0.0f)) {
        return (float3)(0.0f);
    }
    const float exponent = phong_exponent(bsdf);
    const float lobe = 0.5f * M_1_PI_F * powr(fmin(cosine, 1.0f), exponent);
    *pdf = (exponent + 1.0f) * lobe;
    return bsdf->specular * ((exponent + 2.0f) * lobe * wi.z);
}

/// Directions below the surface are drawn too, and count for nothing.
static inline BsdfSample phong_sample(const Bsdf* bsdf, float3 wo, float2 v) {
    const float cosine = pow(1.0f - v.x, 1.0f / (phong_exponent(bsdf) + 1.0f));
    const float sine = sqrt(fmax(0.0f, 1.0f - cosine * cosine));
    const Frame about = make_frame((float3)(-wo.xy, wo.z));
    BsdfSample sample = no_bsdf_sample();
    sample.wi = frame_to_world(&about, (float3)(sine * circle_point(v.y), cosine));
    return sample;
}

/// A narrow lobe reflects as much as the cosine of its middle says. A wide one reflects more at grazing
/// angles, though half of it lies below the surface.
static inline float3 phong_albedo(const Bsdf* bsdf, float3 wo) {
    return bsdf->specular * fmax(wo.z, 0.5f * bsdf->alpha.x);
}

#endif
