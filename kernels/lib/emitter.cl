// SPDX-License-Identifier: Apache-2.0
// Lights: choosing one, lighting a point with it, and sending a walk from it.
#ifndef NEARLIGHT_LIB_EMITTER
#define NEARLIGHT_LIB_EMITTER

#include "lib/random.cl"
#include "lib/sampling.cl"
#include "lib/scene.cl"

/// The smallest index with u < cdf[index], or the last one if rounding leaves u above all entries.
inline uint search_cdf(const global float* cdf, uint count, float u) {
    uint low = 0;
    uint high = count - 1;
    while (low < high) {
        const uint middle = (low + high) / 2;
        if (u < cdf[middle]) {
            high = middle;
        } else {
            low = middle + 1;
        }
    }
    return low;
}

/// The first emitter of the table with u < cdf, or the last one if rounding leaves u above all entries.
inline uint choose_emitter(const SceneView* scene, float u) {
    uint low = 0;
    uint high = scene->info->emitter_count - 1;
    while (low < high) {
        const uint middle = (low + high) / 2;
        if (u < scene->emitters[middle].cdf) {
            high = middle;
        } else {
            low = middle + 1;
        }
    }
    return low;
}

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

inline float3 environment_radiance(const SceneView* scene, float3 direction) {
    if (scene->environment->width == 0) {
        return (float3)(0.0f);
    }
    const uint2 pixel = environment_pixel(scene, direction);
    return scene->environment_pixels[pixel.y * scene->environment->width + pixel.x].xyz;
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

/// A world direction, chosen by the tables. `pdf` gets its density (per steradian), and `radiance` what comes
/// from there.
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
    *radiance = scene->environment_pixels[pixel.y * width + pixel.x].xyz;
    return rotate_to_world(scene->environment->world_to_local,
                           (float3)(sin(phi) * sine, cosine, -cos(phi) * sine));
}

/// Intensity of a point or spot light towards `direction` (unit, away from the light), W/sr.
inline float3 delta_intensity(const global Emitter* emitter, float3 direction) {
    const float3 intensity = load3(emitter->radiance);
    if (emitter->type == NEARLIGHT_EMITTER_POINT) {
        return intensity;
    }
    const float angle = acos(clamp(dot(direction, load3(emitter->direction)), -1.0f, 1.0f));
    if (angle <= emitter->beam_angle) {
        return intensity;
    }
    const float width = emitter->cutoff_angle - emitter->beam_angle;
    return angle >= emitter->cutoff_angle ? (float3)(0.0f)
                                          : intensity * ((emitter->cutoff_angle - angle) / width);
}

/// Irradiance at x (normal n) from a point or spot light.
inline float3 delta_irradiance(const SceneView* scene, const global Emitter* emitter, float3 x, float3 n) {
    const float3 to_light = load3(emitter->position) - x;
    const float squared = dot(to_light, to_light);
    const float distance = sqrt(squared);
    const float cosine = dot(n, to_light) / distance;
    if (!(cosine > 0.0f)) {
        return (float3)(0.0f);
    }
    const float3 intensity = delta_intensity(emitter, -to_light / distance);
    if (is_black(intensity) || !is_visible(scene, x, load3(emitter->position))) {
        return (float3)(0.0f);
    }
    return intensity * (cosine / squared);
}

/// The point of the triangle `triangle_id` with the given weights of v1 and v2. `normal` gets the unit normal
/// of its front.
inline float3 triangle_point(const SceneView* scene, uint triangle_id, float2 barycentrics, float3* normal) {
    const Triangle triangle = scene->triangles[triangle_id];
    const float3 a = load3(scene->vertices[triangle.v0].position);
    const float3 edge1 = load3(scene->vertices[triangle.v1].position) - a;
    const float3 edge2 = load3(scene->vertices[triangle.v2].position) - a;
    *normal = normalize(cross(edge1, edge2));
    return a + barycentrics.x * edge1 + barycentrics.y * edge2;
}

inline float triangle_area(const SceneView* scene, uint triangle_id) {
    const Triangle triangle = scene->triangles[triangle_id];
    const float3 a = load3(scene->vertices[triangle.v0].position);
    return 0.5f * length(cross(load3(scene->vertices[triangle.v1].position) - a,
                               load3(scene->vertices[triangle.v2].position) - a));
}

/// One-sample estimate of the irradiance at x from one emissive triangle, sampled uniformly over its area.
inline float3 triangle_irradiance(const SceneView* scene, const global Emitter* emitter, float3 x, float3 n,
                                  float2 u) {
    float3 light_normal;
    const float3 point = triangle_point(scene, emitter->triangle, square_to_triangle(u), &light_normal);
    const float3 y = offset_point(scene, point, light_normal);
    const float3 to_light = y - x;
    const float squared = dot(to_light, to_light);
    const float cos_x = dot(n, to_light);
    const float cos_y = -dot(light_normal, to_light);
    if (!(cos_x > 0.0f) || !(cos_y > 0.0f) || !is_visible(scene, x, y)) {
        return (float3)(0.0f);
    }
    return load3(emitter->radiance) * (emitter->area * cos_x * cos_y / (squared * squared));
}

/// One-sample estimate of the irradiance at x from the environment: half the samples follow the cosine, half
/// the table, and each is divided by the density of the mixture (balance heuristic).
inline float3 environment_irradiance(const SceneView* scene, float3 x, float3 n, float choice, float2 u) {
    float3 direction;
    float3 radiance;
    float table_pdf;
    if (choice < 0.5f) {
        direction = to_world_frame(square_to_cosine_hemisphere(u), n);
        const uint2 pixel = environment_pixel(scene, direction);
        radiance = scene->environment_pixels[pixel.y * scene->environment->width + pixel.x].xyz;
        table_pdf = environment_pixel_pdf(scene, pixel);
    } else {
        direction = sample_environment(scene, u, &table_pdf, &radiance);
    }
    const float cosine = dot(n, direction);
    if (!(cosine > 0.0f) || is_black(radiance) ||
        tree_occluded(scene->nodes, scene->tree_triangles, x, direction, 0.0f, INFINITY)) {
        return (float3)(0.0f);
    }
    return radiance * (cosine / (0.5f * (cosine / M_PI_F + table_pdf)));
}

/// Up to this many point and spot lights are all summed. If there are more, they are chosen by chance like
/// the other lights.
#define MAX_DELTA_LOOP 16u

/// Irradiance (W/m²) at x (unit normal n, off its surface) from all lights. Up to MAX_DELTA_LOOP point and
/// spot lights are exact. The others are estimated from `sample_count` samples, for which `seed` tells one
/// receiver from another.
inline float3 direct_irradiance(const SceneView* scene, float3 x, float3 n, uint sample_count, uint seed) {
    const uint emitter_count = scene->info->emitter_count;
    const uint delta_count =
        scene->info->delta_emitter_count <= MAX_DELTA_LOOP ? scene->info->delta_emitter_count : 0;
    float3 irradiance = (float3)(0.0f);
    for (uint i = 0; i < delta_count; ++i) {
        irradiance += delta_irradiance(scene, scene->emitters + i, x, n);
    }
    if (delta_count == emitter_count) {
        return irradiance;
    }
    const float cdf_low = delta_count == 0 ? 0.0f : scene->emitters[delta_count - 1].cdf;
    float3 sum = (float3)(0.0f);
    for (uint s = 0; s < sample_count; ++s) {
        const float2 choice = sample_2d(s, 0, seed);
        const float2 u = sample_2d(s, 1, seed);
        const uint index = max(choose_emitter(scene, cdf_low + choice.x * (1.0f - cdf_low)), delta_count);
        const global Emitter* emitter = scene->emitters + index;
        float3 estimate;
        if (emitter->type == NEARLIGHT_EMITTER_TRIANGLE) {
            estimate = triangle_irradiance(scene, emitter, x, n, u);
        } else if (emitter->type == NEARLIGHT_EMITTER_ENVIRONMENT) {
            estimate = environment_irradiance(scene, x, n, choice.y, u);
        } else {
            estimate = delta_irradiance(scene, emitter, x, n);
        }
        sum += estimate * ((1.0f - cdf_low) / emitter->probability);
    }
    return irradiance + sum / (float)sample_count;
}

/// A particle that leaves a light.
typedef struct EmittedParticle {
    float3 origin;
    float3 direction;
    float3 flux;  // W, divided by the density with which the particle was chosen
} EmittedParticle;

inline EmittedParticle emit_particle(const SceneView* scene, float2 choice, float2 u_position,
                                     float2 u_direction) {
    const global Emitter* emitter = scene->emitters + choose_emitter(scene, choice.x);
    const float inverse_probability = 1.0f / emitter->probability;
    EmittedParticle particle;
    if (emitter->type == NEARLIGHT_EMITTER_TRIANGLE) {
        float3 normal;
        const float3 point =
            triangle_point(scene, emitter->triangle, square_to_triangle(u_position), &normal);
        particle.origin = offset_point(scene, point, normal);
        particle.direction = to_world_frame(square_to_cosine_hemisphere(u_direction), normal);
        particle.flux = load3(emitter->radiance) * (M_PI_F * emitter->area * inverse_probability);
    } else if (emitter->type == NEARLIGHT_EMITTER_ENVIRONMENT) {
        // The particle starts on a disk of the scene's size that faces the direction from which the light
        // comes.
        float pdf;
        float3 radiance;
        const float3 from = sample_environment(scene, u_direction, &pdf, &radiance);
        const float radius = scene->environment->scene_radius;
        const float r = radius * sqrt(u_position.x);
        const float phi = 2.0f * M_PI_F * u_position.y;
        particle.origin = load3(scene->environment->scene_center) + radius * from +
                          to_world_frame((float3)(r * cos(phi), r * sin(phi), 0.0f), from);
        particle.direction = -from;
        particle.flux =
            pdf > 0.0f ? radiance * (M_PI_F * radius * radius / pdf * inverse_probability) : (float3)(0.0f);
    } else {
        const bool is_spot = emitter->type == NEARLIGHT_EMITTER_SPOT;
        const float cos_max = is_spot ? cos(emitter->cutoff_angle) : -1.0f;
        const float3 axis = is_spot ? load3(emitter->direction) : (float3)(0.0f, 0.0f, 1.0f);
        particle.origin = load3(emitter->position);
        particle.direction = to_world_frame(square_to_cone(u_direction, cos_max), axis);
        particle.flux = delta_intensity(emitter, particle.direction) *
                        (2.0f * M_PI_F * (1.0f - cos_max) * inverse_probability);
    }
    return particle;
}

#endif
