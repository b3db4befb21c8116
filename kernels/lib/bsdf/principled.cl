// SPDX-License-Identifier: Apache-2.0
// Disney's model, and its form for thin sheets, with the definitions of Mitsuba's `principled` and
// `principledthin`. [Burley 2012; Burley 2015]
//
// D (bsdf.cl) is the part of its diffuse term that separates: (1 − flatness) · base/π · (1 − Fo/2)(1 − Fi/2),
// with F the fifth powers of Schlick and the two factors from a transmission curve. S is all else: retro-
// reflection, fake subsurface scattering (flatness), sheen, clearcoat, facets that reflect and refract, and
// the light that diffuses through a thin sheet. No term of S is negative. Behind a body there are facets
// only.
//
// Disney's base reflects as much below facets as without them, so that a white body reflects more than it
// gets. NEARLIGHT_MATERIAL_LAYERED stands for the model of other formats, in which the base gets what its
// facets let through: the curve is another one, and there is no retro-reflection.
#ifndef NEARLIGHT_LIB_BSDF_PRINCIPLED
#define NEARLIGHT_LIB_BSDF_PRINCIPLED

#include "lib/bsdf/dielectric.cl"
#include "lib/sampling.cl"

/// (1 − cosine)⁵, the weight of grazing light in Schlick's approximation.
static inline float schlick_weight(float cosine) {
    const float m = clamp(1.0f - cosine, 0.0f, 1.0f);
    return m * m * m * m * m;
}

/// The base colour with luminance 1.
static inline float3 tint_of(float3 base) {
    const float l = luminance(base);
    return l > 0.0f ? base / l : (float3)(1.0f);
}

/// Facets of the roughness, which `scale` multiplies.
static inline Microfacets principled_facets(const Bsdf* bsdf, float scale) {
    const float roughness = bsdf->alpha.x * scale;
    const float aspect = sqrt(1.0f - 0.9f * bsdf->anisotropic);
    Microfacets facets;
    facets.alpha = fmax(roughness * roughness * (float2)(1.0f / aspect, aspect), 1e-3f);
    facets.beckmann = 0;
    return facets;
}

static inline bool is_thin(const Bsdf* bsdf) {
    return bsdf->flags & NEARLIGHT_MATERIAL_THIN;
}

static inline bool is_layered(const Bsdf* bsdf) {
    return bsdf->flags & NEARLIGHT_MATERIAL_LAYERED;
}

/// The factor of the roughness for light that passes through a thin sheet [Burley 2015, figure 15].
static inline float thin_roughness_scale(const Bsdf* bsdf) {
    return 0.65f * bsdf->eta.x - 0.35f;
}

/// Probabilities of the ways of S, roughly by what each sends. They add up to 1, unless S is black.
typedef struct PrincipledWays {
    float facets;  // reflection or refraction by facets
    float clearcoat;
    float even;     // cosine-distributed, reflected
    float through;  // cosine-distributed, through a thin sheet
} PrincipledWays;

static inline PrincipledWays principled_ways(const Bsdf* bsdf) {
    const bool thin = is_thin(bsdf);
    const float rest = (thin ? 1.0f : 1.0f - bsdf->metallic) * (1.0f - bsdf->spec_trans);
    const float through = thin ? bsdf->transmission.x : 0.0f;
    const float retro = is_layered(bsdf) ? 0.0f : 0.5f * bsdf->alpha.x;
    const float soft = 0.5f * (retro + bsdf->flatness + 0.5f * bsdf->sheen);
    PrincipledWays ways;
    ways.facets = thin ? bsdf->spec_trans : 1.0f;
    ways.clearcoat = thin ? 0.0f : 0.25f * bsdf->clearcoat;
    ways.even =
        (thin ? rest * (1.0f - through) : rest + 0.25f * bsdf->sheen * (1.0f - bsdf->metallic)) * soft;
    ways.through = rest * through;
    if (!bsdf->front && !thin) {
        ways.clearcoat = ways.even = 0.0f;
    }
    const float sum = ways.facets + ways.clearcoat + ways.even + ways.through;
    const float scale = sum > 0.0f ? 1.0f / sum : 0.0f;
    ways.facets *= scale;
    ways.clearcoat *= scale;
    ways.even *= scale;
    ways.through *= scale;
    return ways;
}

/// The share of what facets reflect among the light that they scatter, given the dielectric's reflectance.
static inline float facet_reflection_share(const Bsdf* bsdf, float reflectance) {
    if (is_thin(bsdf)) {
        return 0.5f;
    }
    const float body = (1.0f - bsdf->metallic) * bsdf->spec_trans;
    return bsdf->front ? 1.0f - body * (1.0f - reflectance) : reflectance;
}

/// Schlick's weight for a facet of this cosine: of the angle in the thinner of the media on both sides.
static inline float schlick_weight_at(const Bsdf* bsdf, float cosine) {
    const float eta = bsdf->eta.x;
    const float cos_schlick =
        eta > 1.0f ? cosine : sqrt(fmax(0.0f, 1.0f - (1.0f - cosine * cosine) / (eta * eta)));
    return schlick_weight(cos_schlick);
}

/// Fresnel's factor of the facets, whose reflectance as a dielectric is given. As in Mitsuba, a body of index
/// 1 has no facets at all, not even those of a metal.
static inline float3 principled_fresnel(const Bsdf* bsdf, float reflectance, float cosine) {
    if (!bsdf->front && !is_thin(bsdf)) {
        return (float3)((1.0f - bsdf->metallic) * bsdf->spec_trans * reflectance);
    }
    const float eta = bsdf->eta.x;
    if (eta == 1.0f && !is_thin(bsdf)) {
        return (float3)(0.0f);
    }
    const float grazing = schlick_weight_at(bsdf, cosine);
    const float normal = (eta - 1.0f) * (eta - 1.0f) / ((eta + 1.0f) * (eta + 1.0f));
    const float3 tinted = mix(normal * tint_of(bsdf->base), (float3)(1.0f), grazing);
    const float3 dielectric = mix((float3)(reflectance), tinted, bsdf->spec_tint);
    return is_thin(bsdf) ? dielectric
                         : mix(dielectric, mix(bsdf->base, (float3)(1.0f), grazing), bsdf->metallic);
}

/// α of the clearcoat.
static inline float clearcoat_alpha(const Bsdf* bsdf) {
    return mix(0.1f, 0.001f, bsdf->clearcoat_gloss);
}

/// Clearcoat: facets of the distribution GTR1 with half vector m. `pdf` gets the density of their mirror
/// directions.
static inline float clearcoat_eval(const Bsdf* bsdf, float3 wo, float3 wi, float3 m, float* pdf) {
    const float alpha = clearcoat_alpha(bsdf);
    const float a2 = alpha * alpha;
    const float density = (a2 - 1.0f) / (M_PI_F * log(a2) * (1.0f + (a2 - 1.0f) * m.z * m.z));
    const float cosine = dot(wo, m);
    *pdf = density * m.z / (4.0f * cosine);
    Microfacets masking;
    masking.alpha = (float2)(0.25f);
    masking.beckmann = 0;
    return 0.25f * bsdf->clearcoat * mix(schlick_weight_at(bsdf, cosine), 1.0f, 0.04f) * density *
           facet_masking(&masking, wo, m) * facet_masking(&masking, wi, m) * wi.z;
}

/// Retro-reflection, fake subsurface scattering and sheen, times the cosine.
static inline float3 soft_reflection(const Bsdf* bsdf, float3 wo, float3 wi, float3 m) {
    const float fo = schlick_weight(wo.z);
    const float fi = schlick_weight(wi.z);
    const float cosine = dot(wi, m);
    const float r = 2.0f * bsdf->alpha.x * cosine * cosine;
    const float retro = is_layered(bsdf) ? 0.0f : r * (fo + fi + fo * fi * (r - 1.0f));
    const float bent = mix(1.0f, 0.5f * r, fi) * mix(1.0f, 0.5f * r, fo);
    const float subsurface = 1.25f * (bent * (1.0f / (wo.z + wi.z) - 0.5f) + 0.5f);
    const float3 sheen =
        mix((float3)(1.0f), tint_of(bsdf->base), bsdf->sheen_tint) * (bsdf->sheen * schlick_weight(cosine));
    const float opaque = 1.0f - bsdf->spec_trans;
    const float share =
        is_thin(bsdf) ? opaque * (1.0f - bsdf->transmission.x) : opaque * (1.0f - bsdf->metallic);
    const float sheen_share = is_thin(bsdf) ? share : 1.0f - bsdf->metallic;
    const float3 colour = bsdf->base * (M_1_PI_F * mix(retro, subsurface, bsdf->flatness));
    return wi.z * (share * colour + sheen_share * sheen);
}

/// S for light on the viewer's side.
static inline float3 principled_reflection(const Bsdf* bsdf, const PrincipledWays* ways, float3 wo, float3 wi,
                                           float* pdf) {
    const Microfacets facets = principled_facets(bsdf, 1.0f);
    float3 m;
    float facet_pdf;
    float cos_far;
    const float reflection = facet_reflection(&facets, wo, wi, &m, &facet_pdf);
    const float cosine = clamp(dot(wo, m), 0.0f, 1.0f);
    const float reflectance = fresnel_dielectric(cosine, bsdf->eta.x, &cos_far);
    *pdf = ways->facets * facet_reflection_share(bsdf, reflectance) * facet_pdf;
    float3 value = principled_fresnel(bsdf, reflectance, cosine) * reflection;
    if (is_thin(bsdf)) {
        value *= bsdf->spec_trans;
    } else if (!bsdf->front) {
        return value;
    }
    if (ways->clearcoat > 0.0f && cosine > 0.0f) {
        float clearcoat_pdf;
        value += clearcoat_eval(bsdf, wo, wi, m, &clearcoat_pdf);
        *pdf += ways->clearcoat * clearcoat_pdf;
    }
    if (ways->even > 0.0f) {
        value += soft_reflection(bsdf, wo, wi, m);
        *pdf += ways->even * wi.z * M_1_PI_F;
    }
    return value;
}

/// S for light that comes through a body.
static inline float3 principled_refraction(const Bsdf* bsdf, const PrincipledWays* ways, float3 wo, float3 wi,
                                           float* pdf) {
    const Microfacets facets = principled_facets(bsdf, 1.0f);
    const float3 m = facet_between(wo, wi, bsdf->eta.x);
    float cos_far;
    const float reflectance = fresnel_dielectric(clamp(dot(wo, m), 0.0f, 1.0f), bsdf->eta.x, &cos_far);
    const float refraction = facet_refraction(&facets, wo, wi, m, bsdf->eta.x, pdf);
    *pdf *= ways->facets * (1.0f - facet_reflection_share(bsdf, reflectance));
    return sqrt(bsdf->base) *
           ((1.0f - bsdf->metallic) * bsdf->spec_trans * (1.0f - reflectance) * refraction);
}

/// Whether the facet with the normal m has the light on its far side. Only with this condition of Mitsuba's
/// does it let light through a thin sheet; for an oblique viewer it is not the same from both ends.
static inline bool facet_passes(const Bsdf* bsdf, float3 wo, float3 wi, float3 m) {
    const float3 light = bsdf->flux ? (float3)(wo.xy, -wo.z) : wi;
    return dot(light, m) < 0.0f;
}

/// S for light that comes through a thin sheet: as if facets on the viewer's side reflected the direction,
/// and evenly.
static inline float3 thin_passage(const Bsdf* bsdf, const PrincipledWays* ways, float3 wo, float3 wi,
                                  float* pdf) {
    const Microfacets facets = principled_facets(bsdf, thin_roughness_scale(bsdf));
    const float3 reflected = (float3)(wi.xy, -wi.z);
    float3 m;
    float cos_far;
    float passage = facet_reflection(&facets, wo, reflected, &m, pdf);
    if (!facet_passes(bsdf, wo, wi, m)) {
        passage = 0.0f;
        *pdf = 0.0f;
    }
    const float reflectance = fresnel_dielectric(clamp(dot(wo, m), 0.0f, 1.0f), bsdf->eta.x, &cos_far);
    const float evenly = reflected.z * M_1_PI_F;
    *pdf = ways->facets * 0.5f * *pdf + ways->through * evenly;
    return bsdf->base * (bsdf->spec_trans * (1.0f - reflectance) * passage +
                         (1.0f - bsdf->spec_trans) * bsdf->transmission.x * evenly);
}

static inline float3 principled_eval(const Bsdf* bsdf, float3 wo, float3 wi, float* pdf) {
    const PrincipledWays ways = principled_ways(bsdf);
    if (wi.z > 0.0f) {
        return principled_reflection(bsdf, &ways, wo, wi, pdf);
    }
    if (is_thin(bsdf)) {
        return thin_passage(bsdf, &ways, wo, wi, pdf);
    }
    return principled_refraction(bsdf, &ways, wo, wi, pdf);
}

/// A normal of the clearcoat's facets.
static inline float3 sample_clearcoat_facet(const Bsdf* bsdf, float2 v) {
    const float alpha = clearcoat_alpha(bsdf);
    const float a2 = alpha * alpha;
    const float cos2 = clamp((1.0f - pow(a2, 1.0f - v.x)) / (1.0f - a2), 0.0f, 1.0f);
    return (float3)(sqrt(1.0f - cos2) * circle_point(v.y), sqrt(cos2));
}

static inline BsdfSample principled_sample(const Bsdf* bsdf, float3 wo, float u, float2 v) {
    const PrincipledWays ways = principled_ways(bsdf);
    BsdfSample sample = no_bsdf_sample();
    if (u >= ways.facets) {
        u -= ways.facets;
        if (u < ways.clearcoat) {
            reflect_at(wo, sample_clearcoat_facet(bsdf, v), &sample);
        } else {
            sample.wi = square_to_cosine_hemisphere(v);
            sample.wi.z *= u - ways.clearcoat < ways.even ? 1.0f : -1.0f;
        }
        return sample;
    }
    u /= ways.facets;
    const bool thin_through = is_thin(bsdf) && u >= 0.5f;
    const Microfacets facets = principled_facets(bsdf, thin_through ? thin_roughness_scale(bsdf) : 1.0f);
    const float3 m = sample_visible_facet(&facets, wo, v);
    const float cosine = clamp(dot(wo, m), 0.0f, 1.0f);
    const float eta = bsdf->eta.x;
    float cos_far;
    const float reflectance = fresnel_dielectric(cosine, eta, &cos_far);
    if (is_thin(bsdf) || u < facet_reflection_share(bsdf, reflectance)) {
        reflect_at(wo, m, &sample);
        if (thin_through) {
            sample.wi.z = -sample.wi.z;
            sample.wi = facet_passes(bsdf, wo, sample.wi, m) ? sample.wi : (float3)(0.0f);
        }
    } else {
        refract_at(wo, m, cos_far, eta, &sample);
    }
    return sample;
}

/// The estimate is rough but good enough to steer sampling.
static inline float3 principled_albedo(const Bsdf* bsdf, float3 wo) {
    const bool thin = is_thin(bsdf);
    const float cosine = mix(wo.z, 0.65f, 0.8f * bsdf->alpha.x * bsdf->alpha.x);
    float cos_far;
    const float reflectance = fresnel_dielectric(cosine, bsdf->eta.x, &cos_far);
    const float3 fresnel = principled_fresnel(bsdf, reflectance, cosine);
    const float passes = bsdf->spec_trans * (1.0f - reflectance);
    if (!bsdf->front && !thin) {
        return fresnel + (1.0f - bsdf->metallic) * passes * sqrt(bsdf->base);
    }
    const float opaque = 1.0f - bsdf->spec_trans;
    const float share = thin ? opaque * (1.0f - bsdf->transmission.x) : opaque * (1.0f - bsdf->metallic);
    const float soft = mix(is_layered(bsdf) ? 0.0f : 0.1f * bsdf->alpha.x, 1.0f, bsdf->flatness);
    const float3 even = share * (soft * bsdf->base + 0.1f * bsdf->sheen);
    if (thin) {
        return bsdf->spec_trans * fresnel + passes * bsdf->base + even +
               opaque * bsdf->transmission.x * bsdf->base;
    }
    return fresnel + (1.0f - bsdf->metallic) * passes * sqrt(bsdf->base) + even + 0.02f * bsdf->clearcoat;
}

#endif
