// SPDX-License-Identifier: Apache-2.0
// A path from the camera: how it goes on from each surface, by D, which is a receiver, or by the part S of
// coats, metals and glass, and the light that it meets or finds in S on the way.
#ifndef NEARLIGHT_LIB_CAMERA_PATH
#define NEARLIGHT_LIB_CAMERA_PATH

#include "lib/camera_sample.cl"
#include "lib/path_ray.cl"

#define SURE_SURFACES 16   // surfaces before chance ends paths
#define SURE_WEIGHT 0.02f  // weight below which chance then ends a path sooner

/// A path from the camera, at one of its surfaces.
typedef struct CameraPath {
    PathRay ray;
    float3 camera_light;  // CameraVertex.camera_light so far
    uint key;             // of the path's own random numbers
    uint pixel_key;       // of the sequences that all samples of the pixel share
    uint sample;          // of the pixel
    uint sequence;        // key of the random numbers that receivers of the pixel share, of one branch
    uint undivided;       // 1: there are two branches, and no surface with two ways on was met yet
    uint mode;            // BSDF_CAMERA until a surface scatters the path, then BSDF_RADIANCE
    float t_min;          // where the first surface may lie on the ray
    float t_max;
    float filter_weight;
    float2 film;  // CameraVertex.film_x and film_y
    uint flags;   // NEARLIGHT_VERTEX_OWN_PIXEL or 0
} CameraPath;

/// The ways on from a surface.
#define WAY_END 0u       // none
#define WAY_RECEIVER 1u  // the path ends here: the Lambertian part is its receiver
#define WAY_ON 2u        // the path has a new direction

/// Decides at a surface with two ways on. The first division gives each branch one way with its full weight:
/// branch 0 the first way, branch 1 the second. Later ones choose the second with probability p. Returns true
/// for the second way.
static inline bool take_second_way(CameraPath* path, uint branch, float p, float u) {
    if (path->undivided) {
        path->undivided = 0;
        if (branch == 1) {
            path->camera_light = (float3)(0.0f);  // what was seen so far is counted by branch 0
        }
        return branch == 1;
    }
    const bool second = u < p;
    path->ray.throughput *= 1.0f / (second ? p : 1.0f - p);
    return second;
}

/// The random numbers of a path at one surface.
typedef struct SurfaceNumbers {
    float model;  // for masks and blends
    float part;   // D or S
    float lobe;   // within S
    float2 direction;
    uint light_key;  // of the sequence of light samples
    float end;       // whether the path ends by chance
} SurfaceNumbers;

/// Both branches of a sample have the same numbers, because they are one path up to where they divide.
static inline SurfaceNumbers surface_numbers(const CameraPath* path, uint step) {
    const uint key = surface_key(path->pixel_key, step);
    const float2 way = sample_2d(path->sample, DIMENSION_OF_WAYS, key);
    SurfaceNumbers numbers;
    numbers.model = model_number(path->sample, key);
    numbers.part = way.x;
    numbers.lobe = way.y;
    numbers.direction = sample_2d(path->sample, DIMENSION_OF_DIRECTIONS, key);
    numbers.light_key = key;
    numbers.end = to_unit_float(random_uint4((uint4)(path->key, step, 0x9d5u, 0x1u)).x);
    return numbers;
}

/// Which of the receivers of the pixel that share a sequence is that of this sample.
static inline uint sequence_index(const CameraPath* path) {
    return path->sample % NEARLIGHT_SEQUENCE_RECEIVERS;
}

/// How many of `max_count` light samples a surface takes whose S reflects `specular`: fewer where its light
/// weighs little in the pixel, and one where a rough surface has scattered the path, whose chance direction
/// makes more noise there.
static inline uint light_sample_count(const CameraPath* path, float3 specular, uint max_count) {
    if (path->mode != BSDF_CAMERA) {
        return 1;
    }
    const float weight = fmin(luminance(path->ray.throughput * specular), 1.0f);
    return max(1u, (uint)ceil((float)max_count * weight));
}

/// Whether a surface looks for lights in its S by more than the ray of the path: highlights on what the
/// camera sees straight or in mirrors and glass are the largest part of the noise of glossy rooms.
static inline bool looks_for_lights(const SceneView* scene, const CameraPath* path,
                                    const SurfaceBsdf* surface) {
    const bool is_glass = surface->bsdf.model == NEARLIGHT_BSDF_DIELECTRIC;  // its two ways divide the path
    return path->mode == BSDF_CAMERA && has_sampled_lights(scene) && !is_glass &&
           !is_delta_only(&surface->bsdf);
}

/// How a surface asks lights, up to `max`. Its S reflects `specular`, and its D is a receiver if
/// `is_receiver` is set.
static inline LightQuota surface_quota(const SceneView* scene, const CameraPath* path,
                                       const SurfaceBsdf* surface, float3 specular, bool is_receiver,
                                       LightQuota max) {
    LightQuota quota = max;
    const bool looks = looks_for_lights(scene, path, surface);
    quota.samples = max.samples > 0 ? light_sample_count(path, specular, max.samples) : 0;
    quota.rays = looks ? max.rays : 1;
    // Rays of the bundle look for the sky on the receiver's side alone, and by its own normal.
    const bool shares_sky = looks && is_receiver && !surface->mapped && !may_transmit(&surface->bsdf);
    quota.bundle_rays = shares_sky ? max.bundle_rays : 0;
    return quota;
}

/// Follows the path by the part S of a surface, after adding what light samples find in it. Where S both
/// reflects and lets light through, the first division of the path gives branch 0 what is let through and
/// branch 1 the reflection.
static inline uint follow_specular(const SceneView* scene, CameraPath* path, const SurfaceHit* hit,
                                   const SurfaceBsdf* surface, uint branch, LightQuota quota,
                                   const SurfaceNumbers* numbers) {
    if (quota.samples == 0) {
        return WAY_END;
    }
    path->camera_light +=
        path->ray.throughput * reflected_light(scene, hit, surface, BSDF_S, &quota, numbers->light_key);
    path->camera_light += looked_for_light(scene, &path->ray, hit, surface, BSDF_S, &quota,
                                           sequence_index(path) * (quota.rays - 1), path->sequence);
    float choice = numbers->lobe;
    const float reflected = path->undivided ? reflection_probability(surface, numbers->direction) : 1.0f;
    if (reflected > 0.0f && reflected < 1.0f) {
        const bool second = take_second_way(path, branch, 0.5f, 0.0f);
        path->ray.throughput *= second ? reflected : 1.0f - reflected;
        choice = second ? 0.0f : 0x1.fffffep-1f;
    }
    if (!scatter_ray(scene, &path->ray, hit, surface, BSDF_S, choice, numbers->direction)) {
        return WAY_END;
    }
    if (path->ray.veils == 0) {
        share_lights(&path->ray, &quota);
        path->mode = path->ray.pdf > 0.0f ? BSDF_RADIANCE : path->mode;
    }
    return WAY_ON;
}

/// Follows the path over one surface. Returns a WAY_…; `albedo` gets what D reflects, and `quota` is turned
/// from what the surface may ask of lights into what it asks.
static inline uint follow_surface(const SceneView* scene, CameraPath* path, const SurfaceHit* hit,
                                  const SurfaceBsdf* surface, uint branch, LightQuota* quota,
                                  const SurfaceNumbers* numbers, float3* albedo) {
    const float3 wo = world_to_frame(&surface->frame, surface->wo);
    *albedo = surface->bsdf.diffuse * diffuse_transmission(scene, surface->bsdf.curve, wo.z);
    const float3 specular = s_albedo(&surface->bsdf, wo);
    const bool has_diffuse = !is_black(*albedo);
    if (is_black(specular)) {
        quota->bundle_rays = 0;
        return has_diffuse ? WAY_RECEIVER : WAY_END;
    }
    *quota = surface_quota(scene, path, surface, specular, has_diffuse, *quota);
    if (has_diffuse) {
        const float share = luminance(specular) / (luminance(specular) + luminance(*albedo));
        if (!take_second_way(path, branch, clamp(share, 0.05f, 0.95f), numbers->part)) {
            return WAY_RECEIVER;
        }
    }
    return follow_specular(scene, path, hit, surface, branch, *quota, numbers);
}

/// Ends long paths by chance, but not before many surfaces: paths over tens of them show in diamonds and
/// facing mirrors. Returns false where the path ends.
static inline bool goes_on(CameraPath* path, uint step, float u) {
    if (step < SURE_SURFACES) {
        return true;
    }
    const float survival = fmin(MAX_SURVIVAL, carried_part(&path->ray, (float3)(1.0f)) / SURE_WEIGHT);
    path->ray.throughput /= survival;
    return u < survival;
}

#endif
