// SPDX-License-Identifier: Apache-2.0
// Scattering at a surface: the models' S behind one switch each, D, and both together in world space.
#ifndef NEARLIGHT_LIB_BSDF_BSDF
#define NEARLIGHT_LIB_BSDF_BSDF

#include "lib/bsdf/conductor.cl"
#include "lib/bsdf/dielectric.cl"
#include "lib/bsdf/null.cl"
#include "lib/bsdf/phong.cl"
#include "lib/bsdf/plastic.cl"
#include "lib/bsdf/principled.cl"
#include "lib/bsdf/surface.cl"
#include "lib/bsdf/thin_dielectric.cl"
#include "lib/bsdf/ward.cl"
#include "lib/curve.cl"
#include "lib/outlined.cl"
#include "lib/sampling.cl"

// Parts of a BSDF.
#define BSDF_D 1u
#define BSDF_S 2u

/// Whether S is a mirror image, a refraction or a passage straight on only, so that it has nothing to
/// evaluate.
static inline bool is_delta_only(const Bsdf* bsdf) {
    switch (bsdf->model) {
        case NEARLIGHT_BSDF_PLASTIC:
        case NEARLIGHT_BSDF_CONDUCTOR:
        case NEARLIGHT_BSDF_DIELECTRIC:
            return is_smooth(bsdf);
        case NEARLIGHT_BSDF_PRINCIPLED:
        case NEARLIGHT_BSDF_PHONG:
        case NEARLIGHT_BSDF_WARD:
            return false;
        default:
            return true;
    }
}

/// The roughness α of the lobe by which S reflects, the larger one where it is anisotropic; 0: there is none
/// to evaluate.
static inline float lobe_roughness(const Bsdf* bsdf) {
    if (is_delta_only(bsdf)) {
        return 0.0f;
    }
    const float2 alpha = bsdf->model == NEARLIGHT_BSDF_PRINCIPLED ? principled_facets(bsdf, 1.0f).alpha
                                                                  : microfacets_of(bsdf).alpha;
    return fmax(alpha.x, alpha.y);
}

static inline float3 s_eval(const Bsdf* bsdf, float3 wo, float3 wi, float* pdf) {
    *pdf = 0.0f;
    if (!(wo.z > 0.0f) || wi.z == 0.0f || is_delta_only(bsdf)) {
        return (float3)(0.0f);
    }
    switch (bsdf->model) {
        case NEARLIGHT_BSDF_PLASTIC:
            return plastic_eval(bsdf, wo, wi, pdf);
        case NEARLIGHT_BSDF_CONDUCTOR:
            return conductor_eval(bsdf, wo, wi, pdf);
        case NEARLIGHT_BSDF_DIELECTRIC:
            return dielectric_eval(bsdf, wo, wi, pdf);
        case NEARLIGHT_BSDF_PHONG:
            return phong_eval(bsdf, wo, wi, pdf);
        case NEARLIGHT_BSDF_WARD:
            return ward_eval(bsdf, wo, wi, pdf);
        default:
            return principled_eval(bsdf, wo, wi, pdf);
    }
}

/// A direction drawn from S. Weight and density are set only for a mirror image, a refraction or a passage
/// straight on.
static inline BsdfSample s_sample(const Bsdf* bsdf, float3 wo, float u, float2 v) {
    switch (bsdf->model) {
        case NEARLIGHT_BSDF_PLASTIC:
            return plastic_sample(bsdf, wo, v);
        case NEARLIGHT_BSDF_CONDUCTOR:
            return conductor_sample(bsdf, wo, v);
        case NEARLIGHT_BSDF_DIELECTRIC:
            return dielectric_sample(bsdf, wo, u, v);
        case NEARLIGHT_BSDF_THIN_DIELECTRIC:
        case NEARLIGHT_BSDF_CLEAR_GLASS:
            return thin_dielectric_sample(bsdf, wo, u);
        case NEARLIGHT_BSDF_PRINCIPLED:
            return principled_sample(bsdf, wo, u, v);
        case NEARLIGHT_BSDF_PHONG:
            return phong_sample(bsdf, wo, v);
        case NEARLIGHT_BSDF_WARD:
            return ward_sample(bsdf, wo, v);
        case NEARLIGHT_BSDF_NULL:
            return null_sample(wo);
        default:
            return no_bsdf_sample();
    }
}

static inline float3 s_albedo(const Bsdf* bsdf, float3 wo) {
    switch (bsdf->model) {
        case NEARLIGHT_BSDF_PLASTIC:
            return plastic_albedo(bsdf, wo);
        case NEARLIGHT_BSDF_CONDUCTOR:
            return conductor_albedo(bsdf, wo);
        case NEARLIGHT_BSDF_DIELECTRIC:
            return dielectric_albedo(bsdf, wo);
        case NEARLIGHT_BSDF_THIN_DIELECTRIC:
        case NEARLIGHT_BSDF_CLEAR_GLASS:
            return thin_dielectric_albedo(bsdf, wo);
        case NEARLIGHT_BSDF_PRINCIPLED:
            return principled_albedo(bsdf, wo);
        case NEARLIGHT_BSDF_PHONG:
            return phong_albedo(bsdf, wo);
        case NEARLIGHT_BSDF_WARD:
            return ward_albedo(bsdf);
        case NEARLIGHT_BSDF_NULL:
            return (float3)(1.0f);
        default:
            return (float3)(0.0f);
    }
}

/// T of a transmission curve at a cosine.
static inline float diffuse_transmission(const SceneView* scene, uint curve, float cosine) {
    return curve_value(scene->curves, curve, cosine);
}

/// About ∫ D |cosθi| dωi: at the cosine ½, a boundary lets through as much as on the mean over a hemisphere.
static inline float3 d_albedo(const SceneView* scene, const Bsdf* bsdf, float cosine) {
    return bsdf->diffuse * (diffuse_transmission(scene, bsdf->curve, cosine) *
                            diffuse_transmission(scene, bsdf->curve, 0.5f));
}

/// About what the surface reflects and lets through in all of what arrives evenly from everywhere.
static inline float3 bsdf_albedo(const SceneView* scene, const SurfaceBsdf* s) {
    const float3 wo = world_to_frame(&s->frame, s->wo);
    return wo.z > 0.0f ? d_albedo(scene, &s->bsdf, wo.z) + s_albedo(&s->bsdf, wo) : (float3)(0.0f);
}

/// The BSDF of the point that a ray along `direction` met. `u` (uniform in [0, 1)) decides by chance at masks
/// and blends. Where the side reflects nothing, the BSDF is diffuse and black. Where `without_diffuse` is
/// set, D need not be known, and is black where its colour would be looked up for nothing.
OUTLINED SurfaceBsdf surface_bsdf_of(const SceneView* scene, const SurfaceHit* hit, float3 direction,
                                     uint mode, float u, bool without_diffuse) {
    SurfaceBsdf s = bare_surface(hit, direction, mode);
    s.unscaled = scene->info->veils == NEARLIGHT_VEILS_CLEAR;
    resolve_material(scene, hit, &s, u, without_diffuse);
    const float3 wo = world_to_frame(&s.frame, s.wo);
    const float diffuse = luminance(d_albedo(scene, &s.bsdf, wo.z));
    const float specular = luminance(s_albedo(&s.bsdf, wo));
    s.s_probability = specular > 0.0f ? 1.0f : 0.0f;
    if (diffuse > 0.0f && specular > 0.0f) {
        // Albedos are estimates, and a part that is seldom drawn would be bright when it is.
        s.s_probability = clamp(specular / (diffuse + specular), 0.05f, 0.95f);
    }
    return s;
}

/// The BSDF of the point with all of its parts.
static inline SurfaceBsdf surface_bsdf(const SceneView* scene, const SurfaceHit* hit, float3 direction,
                                       uint mode, float u) {
    return surface_bsdf_of(scene, hit, direction, mode, u, false);
}

/// The flag of a VPL on this surface that says whether a map tilts its shading normal.
static inline uint mapped_flag(const SurfaceBsdf* s) {
    return s->mapped ? NEARLIGHT_VPL_MAPPED : 0;
}

/// The factor of what a map leaves of the light: 0 where its normal and the mesh's see it on different sides.
static inline float map_factor(const SurfaceBsdf* s, float3 wi) {
    const bool flux = s->mode == BSDF_FLUX;
    const float3 light = flux ? s->wo : wi;
    if (!(dot(light, s->unmapped) * dot(light, s->frame.n) > 0.0f)) {
        return 0.0f;
    }
    if (flux) {
        // The normal as the map has it lies in the plane of the mesh's normal and the frame's.
        const float3 as_mapped = s->mapped == MAPPED_TURNED
                                     ? 2.0f * dot(s->frame.n, s->unmapped) * s->unmapped - s->frame.n
                                     : s->frame.n;
        const bool faces = dot(wi, s->unmapped) * dot(wi, as_mapped) > 0.0f;
        if (faces != (s->mapped == MAPPED)) {
            return 0.0f;
        }
    }
    return s->scale * map_shadowing(s->tilt2, dot(light, s->unmapped));
}

/// The factor by which light along wi counts besides the model's value. `eta` is the index on wi's side ÷
/// that on wo's. Radiance shrinks by 1/eta² where it passes a boundary. For flux, a shading normal asks for
/// the ratio of cosines [Veach 1997, §5.3.2].
static inline float transport_factor(const SurfaceBsdf* s, float3 wi, float eta) {
    const float factor = s->mapped ? map_factor(s, wi) : 1.0f;
    if (s->mode != BSDF_FLUX) {
        return s->unscaled ? factor : factor / (eta * eta);
    }
    const float down = fabs(dot(s->wo, s->geometric) * dot(wi, s->frame.n));
    return down > 0.0f ? factor * fabs(dot(s->wo, s->frame.n) * dot(wi, s->geometric)) / down : 0.0f;
}

/// Whether S may turn light to the other side of the surface.
static inline bool may_transmit(const Bsdf* bsdf) {
    return bsdf->model == NEARLIGHT_BSDF_DIELECTRIC ||
           (bsdf->model == NEARLIGHT_BSDF_PRINCIPLED && (is_thin(bsdf) || bsdf->spec_trans > 0.0f));
}

/// Index beyond the surface ÷ that on the viewer's side, for what the surface lets through.
static inline float transmission_eta(const Bsdf* bsdf) {
    const bool body = bsdf->model == NEARLIGHT_BSDF_DIELECTRIC ||
                      (bsdf->model == NEARLIGHT_BSDF_PRINCIPLED && !(bsdf->flags & NEARLIGHT_MATERIAL_THIN));
    return body ? bsdf->eta.x : 1.0f;
}

/// BSDF · |cosθi| of the chosen parts (BSDF_D, BSDF_S or both), without mirror images, refractions and what
/// passes straight on. `pdf` gets the density with which bsdf_sample draws wi for the same parts.
OUTLINED float3 bsdf_eval(const SceneView* scene, const SurfaceBsdf* s, float3 wi, uint parts, float* pdf) {
    const float3 local_wo = world_to_frame(&s->frame, s->wo);
    const float3 local_wi = world_to_frame(&s->frame, wi);
    const Bsdf* bsdf = &s->bsdf;
    const float s_probability = parts == BSDF_D ? 0.0f : (parts == BSDF_S ? 1.0f : s->s_probability);
    float3 value = (float3)(0.0f);
    *pdf = 0.0f;
    if (parts & BSDF_S) {
        value = s_eval(bsdf, local_wo, local_wi, pdf);
        *pdf *= s_probability;
    }
    if ((parts & BSDF_D) && local_wo.z > 0.0f && local_wi.z > 0.0f && !is_black(bsdf->diffuse)) {
        const float cosine = local_wi.z * M_1_PI_F;
        value += bsdf->diffuse * (cosine * diffuse_transmission(scene, bsdf->curve, local_wo.z) *
                                  diffuse_transmission(scene, bsdf->curve, local_wi.z));
        *pdf += (1.0f - s_probability) * cosine;
    }
    const float factor = transport_factor(s, wi, local_wi.z < 0.0f ? transmission_eta(bsdf) : 1.0f);
    *pdf = factor > 0.0f ? *pdf : 0.0f;
    return value * factor;
}

/// The probability with which a direction drawn from S with these numbers `v` is a reflection, where S also
/// lets light through and the lower numbers `u` reflect; otherwise 1.
static inline float reflection_probability(const SurfaceBsdf* s, float2 v) {
    const float3 wo = world_to_frame(&s->frame, s->wo);
    if (s->bsdf.model == NEARLIGHT_BSDF_THIN_DIELECTRIC || s->bsdf.model == NEARLIGHT_BSDF_CLEAR_GLASS) {
        return pane_reflectance(&s->bsdf, wo);
    }
    if (s->bsdf.model != NEARLIGHT_BSDF_DIELECTRIC) {
        return 1.0f;
    }
    float3 m = (float3)(0.0f, 0.0f, 1.0f);
    if (!is_smooth(&s->bsdf)) {
        const Microfacets facets = microfacets_of(&s->bsdf);
        m = sample_visible_facet(&facets, wo, v);
    }
    float cos_far;
    return fresnel_dielectric(clamp(dot(wo, m), 0.0f, 1.0f), s->bsdf.eta.x, &cos_far);
}

/// A direction drawn from the chosen parts. `u` and `v` are independent and uniform in [0, 1).
static inline BsdfSample bsdf_sample(const SceneView* scene, const SurfaceBsdf* s, uint parts, float u,
                                     float2 v) {
    const float s_probability = parts == BSDF_D ? 0.0f : (parts == BSDF_S ? 1.0f : s->s_probability);
    const float3 wo = world_to_frame(&s->frame, s->wo);
    BsdfSample sample = no_bsdf_sample();
    if (!(wo.z > 0.0f)) {
        return sample;
    }
    if (u < s_probability) {
        sample = s_sample(&s->bsdf, wo, u / s_probability, v);
    } else {
        sample.wi = square_to_cosine_hemisphere(v);
    }
    sample.wi = sample.is_straight ? -s->wo : frame_to_world(&s->frame, sample.wi);
    if (sample.is_delta) {
        sample.is_straight = sample.is_straight && !s->mapped;  // maps block shadow rays
        sample.weight *= transport_factor(s, sample.wi, sample.eta) / s_probability;
        return sample;
    }
    const float3 value = bsdf_eval(scene, s, sample.wi, parts, &sample.pdf);
    sample.weight = sample.pdf > 0.0f ? value / sample.pdf : (float3)(0.0f);
    return sample;
}

#endif
