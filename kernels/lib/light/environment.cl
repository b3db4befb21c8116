// SPDX-License-Identifier: Apache-2.0
// The environment: its radiance, and directions that its tables choose.
#ifndef NEARLIGHT_LIB_LIGHT_ENVIRONMENT
#define NEARLIGHT_LIB_LIGHT_ENVIRONMENT

#include "lib/sampling.cl"
#include "lib/scene.cl"

static inline float3 rotate_to_local(const global float* m, float3 v) {
    return (float3)(m[0] * v.x + m[1] * v.y + m[2] * v.z, m[3] * v.x + m[4] * v.y + m[5] * v.z,
                    m[6] * v.x + m[7] * v.y + m[8] * v.z);
}
static inline float3 rotate_to_world(const global float* m, float3 v) {
    return (float3)(m[0] * v.x + m[3] * v.y + m[6] * v.z, m[1] * v.x + m[4] * v.y + m[7] * v.z,
                    m[2] * v.x + m[5] * v.y + m[8] * v.z);
}

/// Where on the map a world direction looks: (column ÷ width, row ÷ height), from 0 to 1. In the light's
/// frame the direction is (sinφ·sinθ, cosθ, −cosφ·sinθ), with φ = 2π·column/width and θ = π·row/height.
static inline float2 map_place(const SceneView* scene, float3 direction) {
    const float3 d = rotate_to_local(scene->environment->world_to_local, direction);
    const float turn = turns_of_point(-d.z, d.x);
    return (float2)(turn - floor(turn), 2.0f * turns_of_cosine(d.y));
}

static inline uint2 pixel_at(const SceneView* scene, float2 place) {
    const uint width = scene->environment->width;
    const uint height = scene->environment->height;
    return (uint2)(min((uint)(place.x * (float)width), width - 1),
                   min((uint)(place.y * (float)height), height - 1));
}

static inline float3 pixel_radiance(const SceneView* scene, uint column, uint row) {
    return scene->environment_pixels[row * scene->environment->width + column].xyz;
}

/// Radiance of an interpolated map, as Mitsuba's `envmap` reads it: columns have their centres at (i +
/// 0.5)/width and go around, and rows lie at i/(height − 1), the first and the last at the poles.
static inline float3 interpolated_radiance(const SceneView* scene, float2 place) {
    const uint width = scene->environment->width;
    const uint height = scene->environment->height;
    const float x = place.x * (float)width + (float)width - 0.5f;
    const float y = place.y * (float)(height - 1);
    const uint column = (uint)x;
    const uint row = min((uint)y, height > 1 ? height - 2 : 0);
    const uint left = column % width;
    const uint right = (column + 1) % width;
    const uint below = min(row + 1, height - 1);
    const float fx = x - (float)column;
    return mix(mix(pixel_radiance(scene, left, row), pixel_radiance(scene, right, row), fx),
               mix(pixel_radiance(scene, left, below), pixel_radiance(scene, right, below), fx),
               y - (float)row);
}

/// Whether there is an environment's map. (SceneInfo.has_maps is about normal and bump maps.)
static inline bool has_map(const SceneView* scene) {
    return scene->environment->width > 0;
}

/// Radiance of the map alone, without a sun. There must be a map.
static inline float3 map_radiance(const SceneView* scene, float2 place) {
    if (scene->environment->interpolated) {
        return interpolated_radiance(scene, place);
    }
    const uint2 pixel = pixel_at(scene, place);
    return pixel_radiance(scene, pixel.x, pixel.y);
}

/// Whether a unit direction meets the sun. The chord tells small angles apart, which a cosine does not.
static inline bool meets_sun(const SceneView* scene, float3 direction) {
    const float3 chord = direction - load3(scene->environment->sun_direction);
    const float half_chord = scene->environment->sun_half_chord;
    return dot(chord, chord) < half_chord * half_chord;
}

/// Density per steradian of sample_sun().
static inline float sun_pdf(const SceneView* scene, float3 direction) {
    return meets_sun(scene, direction) ? 1.0f / (2.0f * M_PI_F * scene->environment->sun_height) : 0.0f;
}

/// A direction that is uniform over the sun's disc.
static inline float3 sample_sun(const SceneView* scene, float2 u) {
    return to_world_frame(square_to_cap(u, scene->environment->sun_height),
                          load3(scene->environment->sun_direction));
}

/// What the sun adds to the map's radiance.
static inline float3 sun_radiance(const SceneView* scene, float3 direction) {
    return meets_sun(scene, direction) ? load3(scene->environment->sun_radiance) : (float3)(0.0f);
}

/// A part of the map that the tables choose as a whole: a block of pixels, or one pixel of a block in which
/// radiance varies. The density of directions is constant inside.
typedef struct MapRegion {
    uint2 first, end;  // columns and rows [first, end)
    float probability;
} MapRegion;

static inline MapRegion block_of_map(const SceneView* scene, uint2 block) {
    const uint size = scene->environment->block_size;
    MapRegion region;
    region.first = block * size;
    region.end = (uint2)(min(region.first.x + size, scene->environment->width),
                         min(region.first.y + size, scene->environment->height));
    region.probability = 0.0f;
    return region;
}

/// The density in a region, per steradian: the cosine of the polar angle and the azimuth are uniform there.
static inline float region_pdf(const SceneView* scene, const MapRegion* region) {
    const float zone = scene->row_cosines[region->first.y] - scene->row_cosines[region->end.y];
    const float turn =
        (float)(region->end.x - region->first.x) / (float)scene->environment->width * 2.0f * M_PI_F;
    return region->probability / (turn * fmax(zone, 1e-12f));
}

/// The region that holds a pixel.
static inline MapRegion region_of_pixel(const SceneView* scene, uint2 pixel) {
    const uint2 block = pixel / scene->environment->block_size;
    const uint columns = scene->environment->block_columns;
    MapRegion region = block_of_map(scene, block);
    region.probability =
        step_of_cdf(scene->row_cdf, block.y) * step_of_cdf(scene->column_cdf + block.y * columns, block.x);
    const uint detail = scene->block_details[block.y * columns + block.x];
    if (detail != NEARLIGHT_NO_DETAIL) {
        const uint2 size = region.end - region.first;
        const uint2 place = pixel - region.first;
        const global float* rows = scene->detail_cdf + detail;
        region.probability *=
            step_of_cdf(rows, place.y) * step_of_cdf(rows + size.y + place.y * size.x, place.x);
        region.first = pixel;
        region.end = pixel + 1;
    }
    return region;
}

/// The region that u selects, and u's place inside of it.
static inline MapRegion choose_region(const SceneView* scene, float2* u) {
    const uint columns = scene->environment->block_columns;
    const CdfStep row = choose_step(scene->row_cdf, scene->environment->block_rows, u->y);
    const CdfStep column = choose_step(scene->column_cdf + row.index * columns, columns, u->x);
    MapRegion region = block_of_map(scene, (uint2)(column.index, row.index));
    region.probability = row.probability * column.probability;
    *u = (float2)(column.within, row.within);
    const uint detail = scene->block_details[row.index * columns + column.index];
    if (detail != NEARLIGHT_NO_DETAIL) {
        const uint2 size = region.end - region.first;
        const global float* rows = scene->detail_cdf + detail;
        const CdfStep y = choose_step(rows, size.y, u->y);
        const CdfStep x = choose_step(rows + size.y + y.index * size.x, size.x, u->x);
        region.probability *= y.probability * x.probability;
        region.first += (uint2)(x.index, y.index);
        region.end = region.first + 1;
        *u = (float2)(x.within, y.within);
    }
    return region;
}

/// A direction towards the map.
typedef struct MapSample {
    float3 direction;  // in the world
    float2 place;      // where it looks, as map_place() has it
    float pdf;         // with which sample_map() chooses the direction, per steradian; 0 without a map
} MapSample;

/// A given direction, with its place on the map and the density with which the tables choose it.
static inline MapSample map_sample_towards(const SceneView* scene, float3 direction) {
    MapSample sample;
    sample.direction = direction;
    sample.place = (float2)(0.0f);
    sample.pdf = 0.0f;
    if (has_map(scene)) {
        sample.place = map_place(scene, direction);
        const MapRegion region = region_of_pixel(scene, pixel_at(scene, sample.place));
        sample.pdf = region_pdf(scene, &region);
    }
    return sample;
}

/// A direction that is uniform over the sun's disc, with its place on the map and the density with which the
/// tables choose it.
static inline MapSample map_sample_towards_sun(const SceneView* scene, float2 u) {
    return map_sample_towards(scene, sample_sun(scene, u));
}

/// A direction that the tables choose. There must be a map.
static inline MapSample sample_map(const SceneView* scene, float2 u) {
    const MapRegion region = choose_region(scene, &u);
    const float cosine = mix(scene->row_cosines[region.first.y], scene->row_cosines[region.end.y], u.y);
    const float sine = sqrt(fmax(0.0f, 1.0f - cosine * cosine));
    const float turn =
        mix((float)region.first.x, (float)region.end.x, u.x) / (float)scene->environment->width;
    const float2 around = circle_point(turn);
    MapSample sample;
    sample.direction = rotate_to_world(scene->environment->world_to_local,
                                       (float3)(around.y * sine, cosine, -around.x * sine));
    sample.place = (float2)(turn, 2.0f * turns_of_cosine(cosine));
    sample.pdf = region_pdf(scene, &region);
    return sample;
}

#endif
