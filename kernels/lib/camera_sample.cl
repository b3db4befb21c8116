// SPDX-License-Identifier: Apache-2.0
// A sample of a pixel: where its path begins, the first surface on its way, and the random numbers there.
#ifndef NEARLIGHT_LIB_CAMERA_SAMPLE
#define NEARLIGHT_LIB_CAMERA_SAMPLE

#include "lib/camera.cl"
#include "lib/scene.cl"

#define MAX_HIDDEN 256  // emitters that one camera ray looks through where they are hidden

typedef struct CameraSample {
    FilmSample film;
    CameraRay ray;
    uint number;     // of the sample
    uint key;        // of the path's own random numbers
    uint pixel_key;  // of the sequences that all samples of the pixel share
} CameraSample;

/// Sample number `sample` of pixel (x, y). If `in_middle` is 1, it goes through the middle of the pixel.
static inline CameraSample camera_sample(const global Camera* camera, uint x, uint y, uint sample,
                                         uint in_middle, uint seed) {
    const uint pixel = y * camera->width + x;
    CameraSample start;
    start.number = sample;
    start.key = random_uint4((uint4)(pixel, sample, seed, 0xca3e7au)).x;
    start.pixel_key = random_uint4((uint4)(pixel, seed, 0xf117u, 0x37u)).x;
    // A sample in the middle of its pixel goes through any part of the lens all the same.
    start.film =
        in_middle ? middle_of_pixel(x, y) : sample_film(camera, x, y, sample_2d(sample, 0, start.pixel_key));
    start.ray = camera_ray(camera, start.film.position, sample_2d(sample, 1, start.pixel_key));
    return start;
}

/// The key of the sequences that the samples of a pixel share at surface number `step`. Samples mostly meet
/// the same surfaces, so that what they choose there is evenly spread over all of them.
static inline uint surface_key(uint pixel_key, uint step) {
    return random_uint4((uint4)(pixel_key, step, 0x5f3759u, 0x1u)).x;
}

// What the dimensions of these sequences are for. Light samples have 0 and 1 (lib/path_ray.cl).
#define DIMENSION_OF_WAYS 2  // between D and S, and within S
#define DIMENSION_OF_DIRECTIONS 3
#define DIMENSION_OF_MODELS 4

/// The number in [0, 1) by which a sample decides between the parts of masks and blends.
static inline float model_number(uint sample, uint surface_key) {
    return sample_2d(sample, DIMENSION_OF_MODELS, surface_key).x;
}

static inline bool is_emitter(const SceneView* scene, const SurfaceHit* hit) {
    return max_component(load3(scene->materials[hit->material].emission.value)) > 0.0f;
}

/// The first surface that the camera sees. Where emitters are hidden, it lies behind all of them, and clip
/// planes end at the first one, as in Mitsuba.
static inline SurfaceHit trace_first(const SceneView* scene, const global Camera* camera,
                                     const CameraRay* ray) {
    SurfaceHit hit = trace_between(scene, ray->origin, ray->direction, ray->t_min, ray->t_max);
    for (uint i = 0; camera->hides_emitters && hit.t >= 0.0f && is_emitter(scene, &hit); ++i) {
        const float passed = hit.t;
        const float3 origin = off_surface(&hit, -hit.geometric);
        hit = i < MAX_HIDDEN ? trace_surface(scene, origin, ray->direction, INFINITY) : no_surface();
        hit.t += hit.t >= 0.0f ? passed : 0.0f;
    }
    return hit;
}

#endif
