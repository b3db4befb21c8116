// SPDX-License-Identifier: Apache-2.0
// Where a camera sample lies on the film and on the lens, and the ray that it sends.
//
// A pixel's own samples are placed by the reconstruction filter (filter importance sampling): with a density
// in proportion to the filter's absolute value over the part of its support that the film has, and with a
// weight of the filter's sign times a constant that makes the expectation of the weights 1. So the
// expectation of a pixel is its filtered light, and no sample is shared between pixels. [Ernst, Stamminger &
// Greiner, Filter Importance Sampling, 2006] Where samples count in the pixels around theirs, too
// (splats.cl), they are spread evenly over their own pixel, and those of pixels at the border also over what
// the film has beyond it. Their weight is then the area for which they stand.
#ifndef NEARLIGHT_LIB_CAMERA
#define NEARLIGHT_LIB_CAMERA

#include "lib/angle.cl"
#include "lib/math.cl"
#include "lib/random.cl"

typedef struct FilmSample {
    float2 position;  // pixels from the top left corner of the picture
    float weight;
    bool is_in_own_pixel;
} FilmSample;

typedef struct CameraRay {
    float3 origin;
    float3 direction;    // unit vector
    float t_min, t_max;  // where surfaces are seen
} CameraRay;

/// The integral of a table's filter from 0 to x pixels, which is odd in x.
static inline float filter_integral(const global Camera* camera, const global float* table, float x) {
    const float place = fmin(fabs(x) / camera->filter_radius, 1.0f) * NEARLIGHT_FILTER_CELLS;
    const uint cell = min((uint)place, NEARLIGHT_FILTER_CELLS - 1u);
    return copysign(mix(table[cell], table[cell + 1], place - (float)cell), x);
}

/// The offset from the middle of the pixel whose integral of the filter's absolute value is `wanted`. `sign`
/// gets that of the filter there.
static inline float invert_filter(const global Camera* camera, float wanted, float* sign) {
    const global float* table = camera->filter_absolute;
    const float absolute = fabs(wanted);
    uint cell = 0;
    for (uint step = 64; step > 0; step /= 2) {
        if (cell + step < NEARLIGHT_FILTER_CELLS && table[cell + step] <= absolute) {
            cell += step;
        }
    }
    const float width = table[cell + 1] - table[cell];
    const float within = width > 0.0f ? fmin((absolute - table[cell]) / width, 1.0f) : 0.5f;
    *sign = camera->filter_signed[cell + 1] < camera->filter_signed[cell] ? -1.0f : 1.0f;
    return copysign(((float)cell + within) / NEARLIGHT_FILTER_CELLS * camera->filter_radius, wanted);
}

/// A sample along one axis, for the pixel with the middle `center` on a film from film_min to film_max. The
/// result is its place, and its weight is multiplied to `weight`.
static inline float sample_filter(const global Camera* camera, float center, float film_min, float film_max,
                                  float u, float* weight) {
    const float low = fmax(film_min - center, -camera->filter_radius);
    const float high = fmin(film_max - center, camera->filter_radius);
    const float from = filter_integral(camera, camera->filter_absolute, low);
    const float to = filter_integral(camera, camera->filter_absolute, high);
    float sign;
    const float offset = invert_filter(camera, mix(from, to, u), &sign);
    *weight *= sign * (to - from) /
               (filter_integral(camera, camera->filter_signed, high) -
                filter_integral(camera, camera->filter_signed, low));
    return center + clamp(offset, low, high);
}

/// A sample along one axis on the film that belongs to the pixel with the middle `center`: its own width, and
/// for pixels at the border of the picture also what the film has beyond it, as far as their filter goes. The
/// result is its place, and `weight` is multiplied by the width.
static inline float sample_own_width(const global Camera* camera, float center, float picture_max,
                                     float film_min, float film_max, float u, float* weight) {
    const bool is_first = center < 1.0f;
    const bool is_last = center > picture_max - 1.0f;
    const float low = is_first ? fmax(center - camera->filter_radius, film_min) : center - 0.5f;
    const float high = is_last ? fmin(center + camera->filter_radius, film_max) : center + 0.5f;
    *weight *= high - low;
    return mix(low, high, u);
}

/// The film sample of pixel (x, y) for the random point u.
static inline FilmSample sample_film(const global Camera* camera, uint x, uint y, float2 u) {
    FilmSample sample;
    sample.weight = 1.0f;
    sample.is_in_own_pixel = true;
    const float2 corner = (float2)((float)x, (float)y);
    if (!(camera->filter_radius > 0.0f)) {
        sample.position = corner + u;
        return sample;
    }
    const float2 center = corner + 0.5f;
    if (camera->splat_reach > 0) {
        sample.position.x = sample_own_width(camera, center.x, (float)camera->width, camera->film_min_x,
                                             camera->film_max_x, u.x, &sample.weight);
        sample.position.y = sample_own_width(camera, center.y, (float)camera->height, camera->film_min_y,
                                             camera->film_max_y, u.y, &sample.weight);
    } else {
        sample.position.x =
            sample_filter(camera, center.x, camera->film_min_x, camera->film_max_x, u.x, &sample.weight);
        sample.position.y =
            sample_filter(camera, center.y, camera->film_min_y, camera->film_max_y, u.y, &sample.weight);
    }
    const float2 offset = fabs(sample.position - center);
    sample.is_in_own_pixel = offset.x <= 0.5f && offset.y <= 0.5f;
    return sample;
}

/// The film sample in the middle of pixel (x, y), which stands for the whole pixel.
static inline FilmSample middle_of_pixel(uint x, uint y) {
    FilmSample sample;
    sample.position = (float2)((float)x + 0.5f, (float)y + 0.5f);
    sample.weight = 1.0f;
    sample.is_in_own_pixel = true;
    return sample;
}

/// A point of the unit disc, uniformly. [Shirley & Chiu, A Low Distortion Map Between Disk and Square, 1997]
static inline float2 square_to_disc(float2 u) {
    const float2 p = 2.0f * u - 1.0f;
    if (p.x == 0.0f && p.y == 0.0f) {
        return p;
    }
    const bool is_wide = fabs(p.x) > fabs(p.y);
    const float r = is_wide ? p.x : p.y;
    const float turns = is_wide ? 0.125f * (p.y / p.x) : 0.25f - 0.125f * (p.x / p.y);
    return r * circle_point(turns);
}

/// The ray through a film position, from the place on the lens that the random point `lens` stands for.
static inline CameraRay camera_ray(const global Camera* camera, float2 film, float2 lens) {
    CameraRay ray;
    const float3 forward = load3(camera->forward);
    const float3 d = load3(camera->corner) + film.x * load3(camera->step_x) + film.y * load3(camera->step_y);
    ray.origin = load3(camera->origin);
    if (camera->is_orthographic) {
        ray.origin += d;
        ray.direction = forward;
        ray.t_min = camera->near_clip;
        ray.t_max = camera->far_clip;
        return ray;
    }
    ray.direction = normalize(d);
    const float3 lens_x = load3(camera->lens_x);
    if (dot(lens_x, lens_x) > 0.0f) {
        const float2 place = square_to_disc(lens);
        const float3 offset = place.x * lens_x + place.y * load3(camera->lens_y);
        ray.origin += offset;
        ray.direction = normalize(camera->focus_distance * d - offset);
    }
    const float cosine = dot(ray.direction, forward);
    ray.t_min = camera->near_clip / cosine;
    ray.t_max = camera->far_clip / cosine;
    return ray;
}

#endif
