// SPDX-License-Identifier: Apache-2.0
// Shadow rays that pass straight through veils: thin panes, masks and `null`, and with --glass clear smooth
// glass bodies too.
//
// A ray that follows the BSDF passes the same veils with the same transmittance in expectation, and keeps
// the density of the surface that scattered it (PathRay). So the two share this light by multiple importance
// sampling. A veil counts as a surface of the path. Veils under normal or bump maps block shadow rays, and
// the rays that pass them bring their light alone.
#ifndef NEARLIGHT_LIB_LIGHT_SHADOW
#define NEARLIGHT_LIB_LIGHT_SHADOW

#include "lib/bsdf/bsdf.cl"
#include "lib/light/sample.cl"
#include "lib/outlined.cl"

/// A material behind ones that stand for others, and its share of the surface.
typedef struct VeilPart {
    const global Material* material;
    float share;
    float turn;  // −1 where a two-sided material turned the frame over
} VeilPart;

/// What a model that stands for no other lets pass straight on, at an angle of the given cosine.
static inline float3 straight_transmittance(const SceneView* scene, const SurfaceHit* hit,
                                            const global Material* material, float cosine) {
    if (material->model == NEARLIGHT_BSDF_NULL) {
        return (float3)(1.0f);
    }
    Bsdf bsdf = black_bsdf();
    bsdf.eta = load3(material->eta);
    bsdf.model = material->model;
    if (material->model == NEARLIGHT_BSDF_DIELECTRIC && scene->info->veils == NEARLIGHT_VEILS_CLEAR) {
        bsdf.alpha = look_up(scene, &material->roughness, hit).number;
        bsdf.model = is_smooth(&bsdf) ? NEARLIGHT_BSDF_CLEAR_GLASS : NEARLIGHT_BSDF_DIELECTRIC;
    }
    if (bsdf.model != NEARLIGHT_BSDF_THIN_DIELECTRIC && bsdf.model != NEARLIGHT_BSDF_CLEAR_GLASS) {
        return (float3)(0.0f);
    }
    return look_up(scene, &material->transmission, hit).color *
           (1.0f - pane_reflectance(&bsdf, (float3)(0.0f, 0.0f, cosine)));
}

/// The share of light along the unit direction that the surface lets pass straight on, over all choices of
/// its masks and blends.
OUTLINED float3 veil_transmittance(const SceneView* scene, const SurfaceHit* hit, float3 direction) {
    const float along = dot(hit->shading, direction);
    float3 sum = (float3)(0.0f);
    // Each nested blend leaves one part waiting, the innermost two.
    VeilPart parts[NEARLIGHT_MAX_BSDF_NESTING + 2];
    parts[0] = (VeilPart){scene->materials + hit->material, 1.0f, 1.0f};
    uint count = along != 0.0f ? 1 : 0;
    while (count > 0 && count < NEARLIGHT_MAX_BSDF_NESTING + 2) {
        VeilPart part = parts[--count];
        const uint model = part.material->model;
        if (model < NEARLIGHT_BSDF_MASK) {
            sum += part.share * straight_transmittance(scene, hit, part.material, fabs(along));
        } else if (model == NEARLIGHT_BSDF_TWO_SIDED) {
            const bool back = part.turn * along > 0.0f;
            part.turn = back ? -part.turn : part.turn;
            part.material = scene->materials + part.material->child[back];
            parts[count++] = part;
        } else if (model == NEARLIGHT_BSDF_MASK || model == NEARLIGHT_BSDF_BLEND) {
            const float share = clamp(look_up(scene, &part.material->reflectance, hit).number.x, 0.0f, 1.0f);
            const global Material* first = scene->materials + part.material->child[0];
            const bool is_mask = model == NEARLIGHT_BSDF_MASK;
            sum += is_mask ? part.share * (1.0f - share) : 0.0f;
            if (!is_mask && share > 0.0f) {
                parts[count++] =
                    (VeilPart){scene->materials + part.material->child[1], part.share * share, part.turn};
            }
            const float of_first = part.share * (is_mask ? share : 1.0f - share);
            if (of_first > 0.0f) {
                parts[count++] = (VeilPart){first, of_first, part.turn};
            }
        }
    }
    return sum;
}

/// Where, along the unit direction of a ray that met a surface, one would start that leaves its other side. A
/// ray that grazes the surface must not skip what stands on it.
static inline float beyond_surface(const SurfaceHit* hit, float3 direction) {
    return hit->t + hit->stand_off / fmax(fabs(dot(hit->geometric, direction)), NEARLIGHT_MIN_GRAZING_COSINE);
}

/// The veils on a ray, and the part of light that they let through.
typedef struct Veiling {
    float3 part;
    uint count;
} Veiling;

/// Follows the ray from x between t_min and t_max straight through the surfaces that it meets, up to one more
/// than `max_veils`, which lets nothing through. Unless `counts_all` is set, the ray ends where nothing is
/// left of the light.
static inline Veiling pass_veils(const SceneView* scene, float3 x, float3 direction, float t_min, float t_max,
                                 uint max_veils, bool counts_all) {
    Veiling veiling = {(float3)(1.0f), 0};
    while (counts_all || !is_black(veiling.part)) {
        const SurfaceHit hit = trace_between(scene, x, direction, t_min, t_max);
        if (hit.t < 0.0f) {
            break;
        }
        if (veiling.count++ == max_veils) {
            veiling.part = (float3)(0.0f);
            break;
        }
        veiling.part *= veil_transmittance(scene, &hit, direction);
        t_min = beyond_surface(&hit, direction);
    }
    return veiling;
}

/// The veils between two places that stand off their surfaces, at most NEARLIGHT_MAX_VEILS + 1, in a scene of
/// veils alone.
static inline Veiling veiling_between(const SceneView* veils, float3 x, float3 y) {
    const float distance = length(y - x);
    return pass_veils(veils, x, (y - x) / distance, 0.0f, distance * NEARLIGHT_SEGMENT_T_MAX,
                      NEARLIGHT_MAX_VEILS, true);
}

/// The part of light that arrives at x from infinitely far away, or 0 through more veils than `max_veils`.
static inline float3 transmittance_to_sky(const SceneView* scene, float3 x, float3 direction,
                                          uint max_veils) {
    return pass_veils(scene, x, direction, 0.0f, INFINITY, max_veils, false).part;
}

/// Whether rays of a bundle find the sky in this direction from x: nothing but veils is in the way. A ray
/// that passes a veil may miss a surface that coincides with it, which hides the sky from bundles.
static inline bool bundle_finds_sky(const SceneView* scene, float3 x, float3 direction) {
    return scene->info->veils == NEARLIGHT_VEILS_NONE ||
           !tree_occluded(scene->nodes, scene->solids, x, direction, 0.0f, INFINITY);
}

/// The part of a light sample that arrives at x, on a path that has room for `max_veils` more surfaces. Veils
/// that are NEARLIGHT_VEILS_THIN block the light of points and directions, as in Mitsuba, where no ray finds
/// such lights behind them.
OUTLINED float3 arriving_part(const SceneView* scene, float3 x, const LightSample* light, uint max_veils) {
    const uint veils = scene->info->veils;
    if (veils == NEARLIGHT_VEILS_NONE || (light->is_delta && veils == NEARLIGHT_VEILS_THIN) ||
        max_veils == 0) {
        return (float3)(light_is_visible(scene, x, light) ? 1.0f : 0.0f);
    }
    const uint limit = min(max_veils, (uint)NEARLIGHT_MAX_VEILS);
    if (light->infinite) {
        return transmittance_to_sky(scene, x, light->direction, limit);
    }
    const float3 to_target = light->target - x;
    const float distance = length(to_target);
    return pass_veils(scene, x, to_target / distance, distance * NEARLIGHT_SEGMENT_T_MIN,
                      distance * NEARLIGHT_SEGMENT_T_MAX, limit, false)
        .part;
}

#endif
