// SPDX-License-Identifier: Apache-2.0
// Rough surfaces as height fields of tiny mirrors: the distribution of their normals (GGX and Beckmann, with
// a roughness along x and one along y of the frame), Smith's masking, and normals as a viewer sees them. Both
// follow Mitsuba 3 (MicrofacetDistribution with visible normals), the rational fit of Beckmann's masking
// included. [Walter et al. 2007; Heitz, Understanding the Masking-Shadowing Function, JCGT 2014]
#ifndef NEARLIGHT_LIB_BSDF_MICROFACET
#define NEARLIGHT_LIB_BSDF_MICROFACET

#include "lib/angle.cl"
#include "lib/bsdf/bsdf_types.cl"
#include "lib/outlined.cl"

typedef struct Microfacets {
    float2 alpha;
    uint beckmann;  // 0: GGX
} Microfacets;

static inline Microfacets microfacets_of(const Bsdf* bsdf) {
    Microfacets facets;
    facets.alpha = fmax(bsdf->alpha, 1e-4f);  // Mitsuba's limit; the other α may be rough
    facets.beckmann = bsdf->flags & NEARLIGHT_MATERIAL_BECKMANN;
    return facets;
}

/// Density of normals m (m.z > 0), in area of facets for each area of surface and steradian.
static inline float facet_density(const Microfacets* facets, float3 m) {
    const float2 slope = m.xy / facets->alpha;
    const float planar = dot(slope, slope);
    const float scale = M_PI_F * facets->alpha.x * facets->alpha.y;
    const float cos2 = m.z * m.z;
    const float spread = planar + cos2;
    const float density =
        facets->beckmann ? exp(-planar / cos2) / (scale * cos2 * cos2) : 1.0f / (scale * spread * spread);
    return density * m.z > 1e-20f ? density : 0.0f;
}

/// The share of facets with the normal m that is visible from v.
static inline float facet_masking(const Microfacets* facets, float3 v, float3 m) {
    if (dot(v, m) * v.z <= 0.0f) {
        return 0.0f;
    }
    const float2 stretched = v.xy * facets->alpha;
    const float tan2 = dot(stretched, stretched) / (v.z * v.z);
    if (!facets->beckmann) {
        return 2.0f / (1.0f + sqrt(1.0f + tan2));
    }
    const float a = rsqrt(tan2);
    return a < 1.6f ? (3.535f + 2.181f * a) * a / (1.0f + (2.276f + 2.577f * a) * a) : 1.0f;
}

/// Inverse of erf() on (−1, 1). [Giles, Approximating the erfinv Function, GPU Computing Gems 2, 2011]
static inline float inverse_erf(float x) {
    const float w = -log((1.0f - x) * (1.0f + x));
    float p;
    if (w < 5.0f) {
        const float t = w - 2.5f;
        p = 2.81022636e-08f;
        p = 3.43273939e-07f + p * t;
        p = -3.5233877e-06f + p * t;
        p = -4.39150654e-06f + p * t;
        p = 0.00021858087f + p * t;
        p = -0.00125372503f + p * t;
        p = -0.00417768164f + p * t;
        p = 0.246640727f + p * t;
        p = 1.50140941f + p * t;
    } else {
        const float t = sqrt(w) - 3.0f;
        p = -0.000200214257f;
        p = 0.000100950558f + p * t;
        p = 0.00134934322f + p * t;
        p = -0.00367342844f + p * t;
        p = 0.00573950773f + p * t;
        p = -0.0076224613f + p * t;
        p = 0.00943887047f + p * t;
        p = 1.00167406f + p * t;
        p = 2.83297682f + p * t;
    }
    return p * x;
}

/// Slopes of Beckmann's surface of roughness 1, along and across the viewer's direction, in proportion to how
/// much of them the viewer sees. The slope along is found by Newton's method, for which all is expressed by
/// x = erf(slope). [Jakob, An Improved Visible Normal Sampling Routine for the Beckmann Distribution, 2014]
static inline float2 sample_beckmann_slopes(float cos_viewer, float2 u) {
    const float limit = 0.9999999f;
    const float tangent = sqrt(fmax(1.0f - cos_viewer * cos_viewer, 1e-12f)) / cos_viewer;
    const float cotangent = 1.0f / tangent;
    const float x_max = erf(cotangent);
    const float along = clamp(u.x, 1e-6f, 1.0f - 1e-6f);
    const float scale = 0.564189584f * tangent;  // tanθ/√π
    const float target = along * (1.0f + x_max + scale * exp(-cotangent * cotangent)) - 1.0f;
    float x = x_max - (x_max + 1.0f) * erf(sqrt(-log(along)));
    for (uint i = 0; i < 4; ++i) {
        const float slope = inverse_erf(clamp(x, -limit, limit));
        x -= (x + scale * exp(-slope * slope) - target) / (1.0f - slope * tangent);
    }
    const float2 at = (float2)(x, 2.0f * clamp(u.y, 1e-6f, 1.0f - 1e-6f) - 1.0f);
    return (float2)(inverse_erf(clamp(at.x, -limit, limit)), inverse_erf(at.y));
}

/// A normal with the density of facet_density · facet_masking(wo) · max0(wo·m) / wo.z, for wo.z > 0.
OUTLINED float3 sample_visible_facet(const Microfacets* facets, float3 wo, float2 u) {
    const float3 stretched = normalize((float3)(wo.xy * facets->alpha, wo.z));
    if (facets->beckmann) {
        const float planar = length(stretched.xy);
        const float2 toward = planar > 0.0f ? stretched.xy / planar : (float2)(1.0f, 0.0f);
        const float2 s = sample_beckmann_slopes(stretched.z, u);
        const float2 slope = (float2)(toward.x * s.x - toward.y * s.y, toward.y * s.x + toward.x * s.y);
        return normalize((float3)(-slope * facets->alpha, 1.0f));
    }
    // This is the half vector to a direction that is uniform over a cap of the sphere. [Dupuy & Benyoub,
    // Sampling Visible GGX Normals with Spherical Caps, 2023]
    const float z = (1.0f - u.x) * (1.0f + stretched.z) - stretched.z;
    const float3 h = stretched + (float3)(sqrt(fmax(0.0f, 1.0f - z * z)) * circle_point(u.y), z);
    return normalize((float3)(h.xy * facets->alpha, fmax(h.z, 1e-7f)));
}

/// Reflection by facets, without Fresnel's factor: density · masking both ways / (4 wo.z). `pdf` gets the
/// density of mirror directions about visible facets. Both are 0 where either side cannot see the facet.
static inline float facet_reflection(const Microfacets* facets, float3 wo, float3 wi, float3* m, float* pdf) {
    *m = normalize(wo + wi);
    *pdf = 0.0f;
    if (!(wi.z > 0.0f) || !(dot(wo, *m) > 0.0f)) {
        return 0.0f;
    }
    *pdf = facet_density(facets, *m) * facet_masking(facets, wo, *m) / (4.0f * wo.z);
    return *pdf * facet_masking(facets, wi, *m);
}

/// About the mean cosine between the viewer and the facets that it sees.
static inline float facing_cosine(const Bsdf* bsdf, float3 wo) {
    return mix(wo.z, 0.65f, 0.4f * fmin(bsdf->alpha.x + bsdf->alpha.y, 2.0f));
}

/// About the share of light that leaves rough facets after one reflection, whatever its direction.
static inline float facet_escape(const Bsdf* bsdf) {
    const float alpha = fmin(0.5f * (bsdf->alpha.x + bsdf->alpha.y), 1.0f);
    return 1.0f - (bsdf->flags & NEARLIGHT_MATERIAL_BECKMANN ? 0.4f : 0.6f) * alpha * sqrt(alpha);
}

static inline float3 mirror(float3 wo, float3 m) {
    return 2.0f * dot(wo, m) * m - wo;
}

#endif
