// SPDX-License-Identifier: Apache-2.0
// The path of a receiver's ray from the first surface that the ray meets: what of that surface's light is
// wanted besides what VPLs bring (lib/receiver_path.cl), and what the receiver leaves to its bundle of it.
#ifndef NEARLIGHT_LIB_CONTINUED_PATH
#define NEARLIGHT_LIB_CONTINUED_PATH

#include "lib/caustic_aim.cl"
#include "lib/outlined.cl"
#include "lib/path_numbers.cl"
#include "lib/receiver_point.cl"
#include "lib/shared_light.cl"
#include "lib/shared_reflection.cl"

/// Paths end by chance at surfaces that send on less than this part of what the ray began with.
#define FULL_PATH_WEIGHT 0.25f

/// Ends weak paths by chance, before anything is spent on the light that their surface reflects. `albedo` is
/// about what the surface reflects of all light, and `first_weight` what the ray began with. From the third
/// surface on, chance may end any path. Returns false where this path ends.
static inline bool survives(PathRay* ray, float3 albedo, uint surfaces, float first_weight, float u) {
    const float part = carried_part(ray, albedo) / first_weight;
    const float survival = surfaces < 3 ? fmin(1.0f, part / FULL_PATH_WEIGHT) : fmin(MAX_SURVIVAL, part);
    if (!(u < survival)) {
        return false;
    }
    ray->throughput /= survival;
    return true;
}

/// What a ray brings over at least one surface, besides what VPLs bring. VPLs stand for the Lambertian part
/// of the first surface, for all paths of up to `vpl_edges` edges from the receiver to a light. On these
/// paths they bring the part `of_vpls` of what the ray would. Wanted are all parts, for up to `max_edges`
/// edges.
typedef struct WantedLight {
    float of_vpls;
    uint max_edges;
    uint vpl_edges;      // at least max_edges
    uint is_shared;      // 1: what the first surface sends by its Lambertian part is for the whole bundle
    uint is_diffuse;     // 1: nothing else is wanted
    uint finds_veiled;   // 1: the bundle gets what the first solid surface behind veils sends by that part
    float shared_limit;  // how much of the light that one path brings from lamps which it met by chance goes
                         // to the bundle, as the radiance of the place that sends it on, W/m²/sr
    const CausticAim* aim;  // of the receiver, whose other rays bring a part of the light over mirrors and
                            // glass; null: none of them aims
} WantedLight;

/// How a ray goes on from its first surface.
typedef struct Continuation {
    uint parts;            // of the first surface that count
    float diffuse_weight;  // of its Lambertian part
    uint max_edges;
    float short_scale;  // of light over up to WantedLight.max_edges edges
    float long_scale;   // of light over more
    uint is_found;      // 1: the ray brings a light that its receiver shares
    float3 shading;     // normal of the first surface
    uint curve;         // its transmission curve
    float3 excess;      // of lamps met by chance, over the limit: it stays with the receiver
} Continuation;

/// Decides what a ray brings. VPLs bring a part of the light of the first surface's Lambertian part, and the
/// ray brings the rest: all of it where a map turns that surface's normal for this viewer. They bring too
/// much on paths that are too long for a receiver behind mirrors or glass. There the ray takes that away, by
/// chance `u`, or else brings what VPLs leave out of paths that are not too long.
static inline Continuation choose_continuation(const SceneView* scene, const SurfaceBsdf* first,
                                               const WantedLight* wanted, float u) {
    const bool has_specular = scene->info->has_specular;
    const float of_vpls = first->mapped == MAPPED_TURNED ? 0.0f : wanted->of_vpls;
    const float kept = 1.0f - of_vpls;
    const bool is_short = wanted->vpl_edges > wanted->max_edges && of_vpls > 0.0f;
    const bool is_kept = kept > 0.0f || has_specular;
    const float chance = !is_short ? 0.0f : (is_kept ? 0.5f : 1.0f);
    Continuation way;
    way.is_found = 0;
    way.excess = (float3)(0.0f);
    if (u < chance) {
        way.parts = BSDF_D;
        way.diffuse_weight = 1.0f;
        way.max_edges = wanted->vpl_edges;
        way.short_scale = 0.0f;
        way.long_scale = -of_vpls / chance;
    } else {
        way.parts = (kept > 0.0f ? BSDF_D : 0u) | (has_specular ? BSDF_S : 0u);
        way.diffuse_weight = kept;
        way.max_edges = wanted->max_edges;
        way.short_scale = 1.0f / (1.0f - chance);
        way.long_scale = 0.0f;
    }
    return way;
}

/// Decides between the parts of a first surface whose Lambertian part sends its light to all receivers of the
/// bundle.
static inline void choose_found_light(const SurfaceBsdf* first, bool is_diffuse, float u, Continuation* way) {
    const bool has_both = first->s_probability > 0.0f && !is_diffuse;
    const float chance = has_both ? clamp(1.0f - first->s_probability, 0.25f, 0.75f) : 1.0f;
    way->is_found = u < chance;
    way->parts = way->is_found ? BSDF_D : BSDF_S;
    way->diffuse_weight = 1.0f;
    way->short_scale = way->is_found ? 1.0f / chance : 1.0f / (1.0f - chance);
    way->shading = first->frame.n;
    way->curve = first->bsdf.curve;
}

/// Whether VPLs bring all light of the Lambertian part of a first surface whose normal no map turned.
static inline bool vpls_bring_diffuse(const WantedLight* wanted) {
    return wanted->of_vpls == 1.0f && wanted->vpl_edges <= wanted->max_edges;
}

/// The first surface that a ray met, and how the ray goes on from it.
static inline SurfaceBsdf first_bsdf(const SceneView* scene, const SurfaceHit* hit, float3 direction,
                                     const WantedLight* wanted, float2 u, Continuation* way) {
    SurfaceBsdf surface =
        surface_bsdf_of(scene, hit, direction, BSDF_RADIANCE, u.x, vpls_bring_diffuse(wanted));
    *way = choose_continuation(scene, &surface, wanted, u.y);
    if (wanted->is_shared && !surface.mapped && !is_black(surface.bsdf.diffuse)) {
        choose_found_light(&surface, wanted->is_diffuse, u.y, way);
    }
    surface.bsdf.diffuse *= way->diffuse_weight;
    return surface;
}

/// What a light sample at the surface number `surfaces` of a path sends back along it. Through veils that
/// make the path longer than WantedLight.max_edges, the light counts as that of a long path.
static inline float3 continued_sample(const SceneView* scene, const SurfaceHit* hit,
                                      const SurfaceBsdf* surface, uint parts, const WantedLight* wanted,
                                      const Continuation* way, uint surfaces, uint seed) {
    const bool is_short = surfaces < wanted->max_edges;
    const bool has_long =
        way->long_scale != 0.0f && (!is_short || scene->info->veils != NEARLIGHT_VEILS_NONE);
    float3 sum = (float3)(0.0f);
    // With n = wanted->max_edges, m = way->max_edges and L(e) for the light over at most e edges, this is
    // short·L(n) + long·(L(m) − L(n)) = (short − long)·L(n) + long·L(m).
#pragma unroll 1
    for (uint length = 0; length < 2; ++length) {
        const float long_scale = has_long ? way->long_scale : 0.0f;
        const float scale = length == 1 ? long_scale : (is_short ? way->short_scale - long_scale : 0.0f);
        if (scale != 0.0f) {
            const uint edges = length == 0 ? wanted->max_edges : way->max_edges;
            const LightQuota quota = {.samples = 1, .rays = 1, .max_veils = edges - surfaces - 1};
            sum += scale * reflected_light(scene, hit, surface, parts, &quota, seed);
        }
    }
    return sum;
}

/// A path whose first surface reflects its light by S to the whole bundle: what the path finds from there on
/// arrives at that surface.
typedef struct BundlePath {
    uint is_one;  // 0: the path is none of these
    GlossyPlace place;
    ArrivingRay ray;  // by which the path goes on from the first surface
    float3 own;       // factor from light that arrives there to the light of the receiver alone
} BundlePath;

/// Whether the bundle gets the light that a first surface at y reflects to a receiver at x by S. Then S is
/// all that counts of the surface.
static inline bool reflects_to_bundle(const FoundReflection* found, const SurfaceBsdf* surface, float3 x,
                                      float3 y, const Continuation* way) {
    const bool is_alone = (way->parts & BSDF_S) && way->long_scale == 0.0f &&
                          (!(way->parts & BSDF_D) || is_black(surface->bsdf.diffuse));
    return found->light.is_wanted && is_alone && !surface->mapped &&
           shares_gloss(x, y, gloss_width(&surface->bsdf), found->spacing);
}

/// Begins the bundle's path at the first surface of a receiver's ray, if it is one. Part of these paths end
/// there: then no part of the surface is left.
static inline BundlePath begin_bundle_path(const FoundReflection* found, float3 x, const SurfaceHit* hit,
                                           const SurfaceBsdf* surface, float model, float u,
                                           Continuation* way) {
    const float3 y = off_surface(hit, hit->geometric);
    BundlePath path;
    path.is_one = reflects_to_bundle(found, surface, x, y, way);
    if (path.is_one) {
        way->parts = u < REFLECTED_PART ? BSDF_S : 0;
        way->short_scale /= REFLECTED_PART;
        path.place = glossy_place(y, hit, surface, model);
    }
    return path;
}

/// Takes what a light sample sends to the first surface of a bundle's path into the draw. The path counts
/// `scale` times.
static inline void find_reflected_sample(const SceneView* scene, const SurfaceHit* hit,
                                         const SurfaceBsdf* surface, const GlossyPlace* place,
                                         const LightSample* light, uint max_veils, float scale, float u,
                                         FoundReflection* found) {
    if (!may_shine(light) || !(light->pdf > 0.0f) || !(dot(surface->frame.n, light->direction) > 0.0f)) {
        return;
    }
    const float3 part = arriving_part(scene, ray_origin(hit, light->direction), light, max_veils);
    if (is_black(part)) {
        return;
    }
    ArrivingRay ray;
    ray.direction = light->direction;
    ray.value = bsdf_eval(scene, surface, light->direction, BSDF_S, &ray.pdf);
    offer_reflection(found, place, &ray, scale * part * light_radiance(scene, light),
                     light->is_delta ? -light->pdf : light->pdf, u);
}

/// Takes what lights send to the first surface of a bundle's path into the draw: each light of which
/// reflected_light() takes all, and one sample of the others. The path counts `scale` times.
static inline void offer_reflected_lights(const SceneView* scene, const SurfaceHit* hit,
                                          const SurfaceBsdf* surface, const GlossyPlace* place,
                                          uint max_veils, float scale, uint seed, FoundReflection* found) {
    const uint exact = exact_light_count(scene);
    const uint count = exact + (has_sampled_lights(scene) ? 1 : 0);
    const LightReceiver at = even_receiver(hit->position, surface->frame.n);
    for (uint i = 0; i < count; ++i) {
        const LightSample light =
            i < exact ? exact_light(scene, i, hit->position)
                      : sample_light(scene, &at, sample_2d(0, 0, seed), sample_2d(0, 1, seed));
        const float u = to_unit_float(random_uint4((uint4)(seed, i, 0xe3ac7u, 0u)).x);
        find_reflected_sample(scene, hit, surface, place, &light, max_veils, scale, u, found);
    }
}

/// A path from a receiver, at one of its surfaces.
typedef struct ContinuedPath {
    PathRay ray;  // that met the surface
    SurfaceHit hit;
    Continuation way;
    BundlePath of_bundle;
    float first_weight;      // of the ray's throughput where it began to count
    float shared_limit;      // WantedLight.shared_limit times that weight
    float3 first_direction;  // from the receiver
    float first_cosine;      // of that direction at the receiver
    uint is_specular;        // 1: only mirrors, glass and veils so far, rough glass among them
    ReceivedLight light;
} ContinuedPath;

/// Adds the light of a lamp that the path met by chance, for the bundle or the receiver. Such light is rare
/// and bright where light samples find none of it, as behind glass. So what exceeds the limit of a bundle's
/// light stays with the receiver, where it is a bright dot and not a bright tile.
static inline void add_by_chance(ContinuedPath* path, float3 light) {
    const bool is_shared = path->way.is_found || path->of_bundle.is_one;
    const float brightest = max_component(light);
    const bool exceeds = is_shared && brightest > path->shared_limit && brightest < INFINITY;
    const float part = exceeds ? path->shared_limit / brightest : 1.0f;
    path->light.indirect += part * light;
    path->way.excess += (1.0f - part) * light;
}

/// The part that counts of a lamp's light which the path brings: rays that aim bring the rest of what came
/// over mirrors and glass alone.
static inline float part_beside_aimed(const ContinuedPath* path, const WantedLight* wanted) {
    return wanted->aim != 0 && path->is_specular
               ? unaimed_part(wanted->aim, path->first_cosine, path->first_direction)
               : 1.0f;
}

/// Adds the light that the path meets after `surfaces` surfaces. What came straight through veils is direct
/// light, of the receiver or of the first surface of a bundle's path. The bundle's goes into the draw.
static inline void add_met_light(const SceneView* scene, ContinuedPath* path, const WantedLight* wanted,
                                 uint surfaces, float u, FoundReflection* found) {
    const float scale = surfaces < wanted->max_edges ? path->way.short_scale : path->way.long_scale;
    const PathRay* ray = &path->ray;
    const MetLight met = find_met_light(scene, ray, &path->hit);
    const float3 brought = scale * ray->throughput * met.radiance;
    if (path->of_bundle.is_one && ray->veils + 1 == surfaces) {
        offer_reflection(found, &path->of_bundle.place, &path->of_bundle.ray, brought, met.of_others, u);
    } else if (ray->veils == surfaces) {
        path->light.direct += brought * met_weight(ray, &met);
    } else {
        add_by_chance(path, brought * (met_weight(ray, &met) * part_beside_aimed(path, wanted)));
    }
}

/// Adds the light of lamps that a surface of the path reflects, and scatters the ray there. At the first
/// surface of a bundle's path the light goes into the draw, and the ray goes on to bring all that arrives
/// there. Returns false where the path ends.
static inline bool reflect_and_scatter(const SceneView* scene, ContinuedPath* path,
                                       const SurfaceBsdf* surface, uint parts, const WantedLight* wanted,
                                       uint surfaces, const PathNumbers* numbers, FoundReflection* found) {
    const float3 before = path->ray.throughput;
    const float survived = max_component(before) / path->first_weight;
    const bool begins_bundle_path = path->of_bundle.is_one && surfaces == 1;
    if (begins_bundle_path) {
        offer_reflected_lights(scene, &path->hit, surface, &path->of_bundle.place, wanted->max_edges - 2,
                               path->way.short_scale * survived, numbers->light_seed, found);
    } else {
        const float part = is_mirror_or_glass(surface, false) ? part_beside_aimed(path, wanted) : 1.0f;
        path->light.indirect += part * before *
                                continued_sample(scene, &path->hit, surface, parts, wanted, &path->way,
                                                 surfaces, numbers->light_seed);
    }
    if (!scatter_ray(scene, &path->ray, &path->hit, surface, parts, numbers->lobe, numbers->direction)) {
        return false;
    }
    if (begins_bundle_path) {
        // All viewers in the bundle share the density of light samples, which must not depend on one of them.
        path->ray.from = even_receiver(path->ray.from.x, surface->frame.n);
        ArrivingRay* ray = &path->of_bundle.ray;
        ray->direction = path->ray.direction;
        ray->pdf = path->ray.pdf;
        ray->value = path->ray.throughput / max_component(before) * ray->pdf;
        path->of_bundle.own = path->ray.throughput / survived;
        path->ray.throughput = (float3)(survived);
        path->shared_limit = wanted->shared_limit;
        path->first_weight = survived;
    }
    return true;
}

/// Whether the bundle gets the Lambertian light of the surface, which the path met straight through veils.
static inline bool is_found_behind_veils(const SceneView* scene, const ContinuedPath* path,
                                         const SurfaceBsdf* surface, const WantedLight* wanted,
                                         uint surfaces) {
    const bool is_behind = path->ray.veils + 1 == surfaces && path->ray.veils <= NEARLIGHT_MAX_VEILS;
    if (!wanted->finds_veiled || !is_behind || surface->mapped || is_black(surface->bsdf.diffuse) ||
        (scene->materials[path->hit.material].flags & NEARLIGHT_MATERIAL_VEIL) != 0) {
        return false;
    }
    // A ray that passes a veil may miss a surface that coincides with it.
    const float3 x = path->ray.from.x;
    const float3 y = off_surface(&path->hit, path->hit.geometric);
    return !tree_occluded(scene->nodes, scene->solids, x, y - x, NEARLIGHT_SEGMENT_T_MIN,
                          NEARLIGHT_SEGMENT_T_MAX);
}

/// Follows the path over one surface to the next. Returns false where it ends.
OUTLINED bool pass_surface(const SceneView* scene, ContinuedPath* path, const WantedLight* wanted,
                           uint surfaces, uint4 keys, FoundReflection* found) {
    const PathNumbers numbers = path_numbers(keys, surfaces);
    SurfaceBsdf surface;
    uint parts = BSDF_D | BSDF_S;
    if (surfaces == 1) {
        surface = first_bsdf(scene, &path->hit, path->ray.direction, wanted,
                             (float2)(numbers.model, numbers.way), &path->way);
        path->of_bundle = begin_bundle_path(found, path->ray.from.x, &path->hit, &surface, numbers.model,
                                            numbers.of_bundle, &path->way);
        parts = path->way.parts;
        if (parts == 0 || path->way.max_edges < 2) {
            return false;
        }
    } else {
        surface = surface_bsdf(scene, &path->hit, path->ray.direction, BSDF_RADIANCE, numbers.model);
        if (is_found_behind_veils(scene, path, &surface, wanted, surfaces)) {
            if (!(surface.s_probability > 0.0f)) {
                return false;
            }
            surface.bsdf.diffuse = (float3)(0.0f);
            parts = BSDF_S;
        }
    }
    if (!survives(&path->ray, bsdf_albedo(scene, &surface), surfaces, path->first_weight, numbers.end) ||
        !reflect_and_scatter(scene, path, &surface, parts, wanted, surfaces, &numbers, found)) {
        return false;
    }
    path->is_specular &= is_mirror_or_glass(&surface, path->ray.pdf == 0.0f) || path->ray.veils == surfaces;
    path->hit = trace_surface(scene, path->ray.origin, path->ray.direction, INFINITY);
    add_met_light(scene, path, wanted, surfaces, numbers.draw, found);
    return path->hit.t >= 0.0f;
}

/// Whether a ray may bring anything over surfaces besides what VPLs bring.
static inline bool brings_more(const SceneView* scene, const WantedLight* wanted) {
    return wanted->of_vpls != 1.0f || scene->info->has_specular || scene->info->has_maps ||
           wanted->vpl_edges > wanted->max_edges;
}

/// Light over at least one surface, from a ray that has met `hit`, the first of them. What `found` keeps for
/// the bundle is left out. If `first_way` is a found light's, all indirect light is what that light brings.
OUTLINED_ON_CPU ReceivedLight continued_light(const SceneView* scene, PathRay ray, SurfaceHit hit,
                                              const WantedLight* wanted, uint4 keys, Continuation* first_way,
                                              FoundReflection* found) {
    ContinuedPath path;
    path.ray = ray;
    path.hit = hit;
    path.first_weight = max_component(ray.throughput);
    path.light = nothing_received();
    path.of_bundle.is_one = 0;
    path.first_direction = ray.direction;
    path.first_cosine = fmax(dot(ray.from.n, ray.direction), 0.0f);
    path.is_specular = 1;
    path.way.max_edges = wanted->vpl_edges;
    path.way.is_found = 0;
    path.way.excess = (float3)(0.0f);
    path.shared_limit = wanted->shared_limit * path.first_weight;
    for (uint surfaces = 1; surfaces < path.way.max_edges; ++surfaces) {
        if (!pass_surface(scene, &path, wanted, surfaces, keys, found)) {
            break;
        }
    }
    if (path.of_bundle.is_one && !is_black(path.light.indirect)) {
        offer_reflection(found, &path.of_bundle.place, &path.of_bundle.ray, path.light.indirect, 0.0f,
                         to_unit_float(random_uint4(keys ^ 0xb0bd1eu).x));
        path.light.indirect = path.way.excess * path.of_bundle.own;
    }
    *first_way = path.way;
    return path.light;
}

#endif
