// SPDX-License-Identifier: Apache-2.0
// The environment: its radiance, and directions that its tables choose.
#ifndef NEARLIGHT_LIB_LIGHT_ENVIRONMENT
#define NEARLIGHT_LIB_LIGHT_ENVIRONMENT

#include "lib/sampling.cl"
#include "lib/scene.cl"

inline float3 rotate_to_local(const global float* m, float3 v) {
    return (float3)(m[0] * v.x + m[1] * v.y + m[2] * v.z, m[3] * v.x + m[4] * v.y + m[5] * v.z,
                    m[6] * v.x + m[7] * v.y + m[8] * v.z);
}
inline float3 rotate_to_world(const global float* m, float3 v) {
    return (float3)(m[0] * v.x + m[3] * v.y + m[6] * v.z, m[1] * v.x + m[4] * v.y + m[7] * v.z,
                    m[2] * v.x + m[5] * v.y + m[8] * v.z);
}

/// Column and row of the environment pixel that a world direction looks at. In the light's frame the
/// direction is (sinφ·sinθ, cosθ, −cosφ·sinθ), with φ = 2π·column/width and θ = π·row/height.
inline uint2 environment_pixel(const SceneView* scene, float3 direction) {
    const float3 d = rotate_to_local(scene->environment->world_to_local, direction);
    const float u = atan2(d.x, -d.z) * (0.5f / M_PI_F);
    const float v = acos(clamp(d.y, -1.0f, 1.0f)) / M_PI_F;
    const uint width = scene->environment->width;
    const uint height = scene->environment->height;
    return (uint2)(min((uint)((u - floor(u)) * (float)width), width - 1),
                   min((uint)(v * (float)height), height - 1));
}

inline float3 map_pixel(const SceneView* scene, uint column, uint row) {
    return scene->environment_pixels[row * scene->environment->width + column].xyz;
}

/// Radiance of an interpolated map, as Mitsuba's `envmap` reads it: columns have their centres at (i +
/// 0.5)/width and go around, and rows lie at i/(height − 1), the first and the last at the poles.
inline float3 interpolated_radiance(const SceneView* scene, float3 direction) {
    const float3 d = rotate_to_local(scene->environment->world_to_local, direction);
    const uint width = scene->environment->width;
    const uint height = scene->environment->height;
    const float u = atan2(d.x, -d.z) * (0.5f / M_PI_F);
    const float x = (u - floor(u)) * (float)width + (float)width - 0.5f;
    const float y = acos(clamp(d.y, -1.0f, 1.0f)) / M_PI_F * (float)(height - 1);
    const uint column = (uint)x;
    const uint row = min((uint)y, height > 1 ? height - 2 : 0);
    const uint left = column % width;
    const uint right = (column + 1) % width;
    const uint below = min(row + 1, height - 1);
    const float fx = x - (float)column;
    return mix(mix(map_pixel(scene, left, row), map_pixel(scene, right, row), fx),
               mix(map_pixel(scene, left, below), map_pixel(scene, right, below), fx), y - (float)row);
}

/// Radiance of the map alone, without a sun.
inline float3 map_radiance(const SceneView* scene, float3 direction) {
    if (scene->environment->width == 0) {
        return (float3)(0.0f);
    }
    if (scene->environment->interpolated) {
        return interpolated_radiance(scene, direction);
    }
    const uint2 pixel = environment_pixel(scene, direction);
    return map_pixel(scene, pixel.x, pixel.y);
}

/// Whether a unit direction meets the sun. The chord tells small angles apart, which a cosine does not.
inline bool meets_sun(const SceneView* scene, float3 direction) {
    const float3 chord = direction - load3(scene->environment->sun_direction);
    const float half_chord = scene->environment->sun_half_chord;
    return dot(chord, chord) < half_chord * half_chord;
}

/// Density per steradian of sample_sun().
inline float sun_pdf(const SceneView* scene, float3 direction) {
    return meets_sun(scene, direction) ? 1.0f / (2.0f * M_PI_F * scene->environment->sun_height) : 0.0f;
}

/// A direction that is uniform over the sun's disc.
inline float3 sample_sun(const SceneView* scene, float2 u) {
    const float height = scene->environment->sun_height * u.x;
    const float r = sqrt(height * (2.0f - height));
    const float phi = 2.0f * M_PI_F * u.y;
    return to_world_frame((float3)(r * cos(phi), r * sin(phi), 1.0f - height),
                          load3(scene->environment->sun_direction));
}

inline float3 environment_radiance(const SceneView* scene, float3 direction) {
    const float3 map = map_radiance(scene, direction);
    return meets_sun(scene, direction) ? map + load3(scene->environment->sun_radiance) : map;
}

/// Density (per steradian) with which sample_environment() chooses directions inside a pixel. The cosine of
/// the polar angle is uniform inside a pixel, so the density is constant there.
inline float environment_pixel_pdf(const SceneView* scene, uint2 pixel) {
    const uint width = scene->environment->width;
    const uint height = scene->environment->height;
    const global float* row = scene->column_cdf + pixel.y * width;
    const float p_row = scene->row_cdf[pixel.y] - (pixel.y == 0 ? 0.0f : scene->row_cdf[pixel.y - 1]);
    const float p_column = row[pixel.x] - (pixel.x == 0 ? 0.0f : row[pixel.x - 1]);
    const float top = cos(M_PI_F * (float)pixel.y / (float)height);
    const float bottom = cos(M_PI_F * (float)(pixel.y + 1) / (float)height);
    return p_row * p_column * (float)width / (2.0f * M_PI_F * fmax(top - bottom, 1e-12f));
}

/// Density with which sample_environment() chooses a direction; 0 without an environment.
inline float map_pdf(const SceneView* scene, float3 direction) {
    return scene->environment->width == 0 ? 0.0f
                                          : environment_pixel_pdf(scene, environment_pixel(scene, direction));
}

/// A world direction, chosen by the tables. `pdf` gets its density (per steradian), and `radiance` what the
/// map sends from there.
inline float3 sample_environment(const SceneView* scene, float2 u, float* pdf, float3* radiance) {
    const uint width = scene->environment->width;
    const uint height = scene->environment->height;
    uint2 pixel;
    pixel.y = search_cdf(scene->row_cdf, height, u.y);
    const global float* row = scene->column_cdf + pixel.y * width;
    pixel.x = search_cdf(row, width, u.x);
    const float row_low = pixel.y == 0 ? 0.0f : scene->row_cdf[pixel.y - 1];
    const float column_low = pixel.x == 0 ? 0.0f : row[pixel.x - 1];
    const float fy = clamp((u.y - row_low) / fmax(scene->row_cdf[pixel.y] - row_low, 1e-20f), 0.0f, 1.0f);
    const float fx = clamp((u.x - column_low) / fmax(row[pixel.x] - column_low, 1e-20f), 0.0f, 1.0f);
    const float top = cos(M_PI_F * (float)pixel.y / (float)height);
    const float bottom = cos(M_PI_F * (float)(pixel.y + 1) / (float)height);
    const float cosine = mix(top, bottom, fy);
    const float sine = sqrt(fmax(0.0f, 1.0f - cosine * cosine));
    const float phi = 2.0f * M_PI_F * ((float)pixel.x + fx) / (float)width;
    *pdf = environment_pixel_pdf(scene, pixel);
    const float3 direction = rotate_to_world(scene->environment->world_to_local,
                                             (float3)(sin(phi) * sine, cosine, -cos(phi) * sine));
    *radiance = map_radiance(scene, direction);
    return direction;
}

#endif
