// SPDX-License-Identifier: Apache-2.0
// Light that rough gloss reflects to the receivers of a bundle (shared_reflections.cl): which surfaces and
// receivers share it, and which of its finds a receiver keeps.
#ifndef NEARLIGHT_LIB_SHARED_REFLECTION
#define NEARLIGHT_LIB_SHARED_REFLECTION

#include "lib/bsdf/bsdf.cl"
#include "lib/shared_light.cl"

/// About how far, in radians, the narrowest lobe of S spreads light; 0 where bundles share none of it because
/// S mirrors light or lets it through.
static inline float gloss_width(const Bsdf* bsdf) {
    switch (bsdf->model) {
        case NEARLIGHT_BSDF_PLASTIC:
        case NEARLIGHT_BSDF_CONDUCTOR:
            return is_smooth(bsdf) ? 0.0f : fmin(bsdf->alpha.x, bsdf->alpha.y);
        case NEARLIGHT_BSDF_PHONG:
            return bsdf->alpha.x;
        case NEARLIGHT_BSDF_WARD:
            return fmin(bsdf->alpha.x, bsdf->alpha.y);
        case NEARLIGHT_BSDF_PRINCIPLED: {
            if (is_thin(bsdf) || bsdf->spec_trans > 0.0f || !bsdf->front) {
                return 0.0f;
            }
            const Microfacets facets = principled_facets(bsdf, 1.0f);
            const float width = fmin(facets.alpha.x, facets.alpha.y);
            return bsdf->clearcoat > 0.0f ? fmin(width, clearcoat_alpha(bsdf)) : width;
        }
        default:
            return 0.0f;
    }
}

/// Whether a receiver at x shares what gloss of this width reflects to it at y. `spacing` is the radius of
/// the receiver's neighbourhood (m).
static inline bool shares_gloss(float3 x, float3 y, float width, float spacing) {
    return width * distance(x, y) > NEARLIGHT_GLOSS_REACH * spacing;
}

/// The part of the rays that go on from gloss where the bundle shares it. More would find more than bundles
/// use.
#define REFLECTED_PART 0.5f

/// The reflection that a receiver keeps of those that its rays find, as FoundLight keeps a light.
typedef struct FoundReflection {
    FoundLight light;  // its place, and the radiance that arrives there
    SharedReflection surface;
    float spacing;  // radius of the receiver's neighbourhood, m
} FoundReflection;

static inline FoundReflection no_reflection_found(void) {
    FoundReflection found;
    found.light = nothing_found(0);
    found.spacing = 0.0f;
    found.surface.triangle = 0;
    found.surface.u = found.surface.v = found.surface.model = found.surface.light_pdf = 0.0f;
    found.surface.arriving = store3((float3)(0.0f));
    return found;
}

/// A glossy place that a ray of a receiver met.
typedef struct GlossyPlace {
    SharedLight light;         // without radiance and weight
    SharedReflection surface;  // without direction and density
    float albedo;              // of S, about
} GlossyPlace;

/// `position` stands off the surface. `model` is the random number that chose between the parts of masks and
/// blends.
static inline GlossyPlace glossy_place(float3 position, const SurfaceHit* hit, const SurfaceBsdf* surface,
                                       float model) {
    GlossyPlace place;
    place.light = nothing_found(0).light;
    place.light.position = store3(position);
    place.light.normal = store3(hit->geometric);
    place.light.shading = pack_direction(surface->frame.n);
    place.surface = no_reflection_found().surface;
    place.surface.triangle = hit->triangle;
    place.surface.u = hit->weights.x;
    place.surface.v = hit->weights.y;
    place.surface.model = model;
    place.albedo = max_component(s_albedo(&surface->bsdf, world_to_frame(&surface->frame, surface->wo)));
    return place;
}

/// What S does with light from one direction, for the receiver whose ray met it.
typedef struct ArrivingRay {
    float3 direction;  // unit vector to where the light comes from
    float3 value;      // S times the cosine
    float pdf;         // with which S draws the direction, per steradian
} ArrivingRay;

/// What counts in draws besides the lobe of the receiver that found the light, as a density per steradian:
/// others may be in the middle of a lobe where this one is at its edge.
#define OTHER_LOBES 0.05f

/// Takes light that arrives at a glossy place into the draw. `light_pdf` is that of SharedReflection, and `u`
/// is uniform in [0, 1).
static inline void offer_reflection(FoundReflection* found, const GlossyPlace* place, const ArrivingRay* ray,
                                    float3 radiance, float light_pdf, float u) {
    const float of_rays = light_pdf < 0.0f ? 0.0f : ray->pdf + OTHER_LOBES;
    SharedLight light = place->light;
    light.radiance = store3(radiance);
    light.weight = max_component(radiance) * (max_component(ray->value) + OTHER_LOBES * place->albedo) /
                   (fabs(light_pdf) + of_rays);
    if (offer_light(&found->light, &light, u)) {
        found->surface = place->surface;
        found->surface.arriving = store3(ray->direction);
        found->surface.light_pdf = light_pdf;
    }
}

#endif
