// SPDX-License-Identifier: Apache-2.0
// A BSDF at one point of a surface, and a direction drawn from it.
//
// A BSDF is D + S: D is its Lambertian part, S everything else (coat, metal, glass). VPLs stand for D alone
// (docs/method.md). Files of this folder hold S of one model each, as up to three functions, without the
// parameters that a model does not need:
//
//     float3     MODEL_eval(bsdf, wo, wi, &pdf)
//         S(wo, wi) · |cosθi| without mirror images and refractions at a smooth surface;
//         pdf: the density of MODEL_sample, per steradian
//     BsdfSample MODEL_sample(bsdf, wo, u, v)
//         a direction drawn from S. Its weight and density are set only where is_delta; other ones follow
//         from MODEL_eval (bsdf.cl)
//     float3     MODEL_albedo(bsdf, wo)
//         an estimate of ∫ S |cosθi| dωi, which only steers sampling
//
// Directions are unit vectors in the frame of the surface, away from it. wo points to the viewer (the side
// that a path comes from) and has wo.z > 0; wi.z < 0 where S lets light through. What a surface lets through
// is given for the transport of flux; bsdf.cl scales it for radiance.
#ifndef NEARLIGHT_LIB_BSDF_TYPES
#define NEARLIGHT_LIB_BSDF_TYPES

#include "lib/math.cl"

/// A model with all its textures looked up. Members are those of Material, unless something else is said.
typedef struct Bsdf {
    uint model;  // none of those that stand for others
    uint flags;
    float3 diffuse;  // colour of D: D = diffuse/π · T(cosθo) · T(cosθi) with the curve's T; 0 without D
    uint curve;
    float3 base;          // principled: colour of the base
    float3 specular;      // tint of what S reflects
    float3 transmission;  // tint of what S lets through
    float2 alpha;         // microfacets' α along x and y of the frame; principled: x is the roughness
    // Conductor: real index; otherwise x is the index beyond the surface ÷ the viewer's, but for panes, thin
    // sheets and clear glass that of the material ÷ outside.
    float3 eta;
    float3 k;  // conductor: imaginary index
    float metallic, anisotropic, spec_trans, spec_tint, sheen, sheen_tint, flatness, clearcoat,
        clearcoat_gloss;  // principled
    uint front;           // 1: the viewer is on the front (outer) side
    uint flux;            // 1: wo points to where light comes from, as on paths of flux
} Bsdf;

/// A direction drawn from a BSDF.
typedef struct BsdfSample {
    float3 wi;      // 0 where nothing could be drawn
    float3 weight;  // BSDF · |cosθi| ÷ density; 0 where nothing could be drawn
    float pdf;      // density per steradian; 0 for a mirror image, a refraction and what passes straight on
    float eta;      // index on wi's side ÷ index on wo's; 1 where the direction stays on wo's side
    uint is_delta;  // 1: a mirror image, a refraction, or straight on
    uint is_straight;  // 1: light passes straight on, as shadow rays do (lib/light/shadow.cl)
} BsdfSample;

static inline BsdfSample no_bsdf_sample(void) {
    BsdfSample sample;
    sample.wi = (float3)(0.0f);
    sample.weight = (float3)(0.0f);
    sample.pdf = 0.0f;
    sample.eta = 1.0f;
    sample.is_delta = 0;
    sample.is_straight = 0;
    return sample;
}

/// Whether microfacets of this roughness count as a smooth surface.
static inline bool is_smooth(const Bsdf* bsdf) {
    return fmax(bsdf->alpha.x, bsdf->alpha.y) < NEARLIGHT_MIN_ALPHA;
}

#endif
