// SPDX-License-Identifier: Apache-2.0
// Points on triangles, and what an emissive one sends.
#ifndef NEARLIGHT_LIB_LIGHT_TRIANGLE
#define NEARLIGHT_LIB_LIGHT_TRIANGLE

#include "lib/light/spherical_triangle.cl"
#include "lib/sampling.cl"
#include "lib/texture.cl"

/// Triangles that are seen under a smaller solid angle (sr) are sampled uniformly over their area.
#define MIN_SOLID_ANGLE 1e-5f

/// Corner and edges of a triangle.
typedef struct Corner {
    float3 origin, edge1, edge2;
} Corner;
static inline Corner triangle_corner(const SceneView* scene, uint triangle_id) {
    const Triangle triangle = scene->triangles[triangle_id];
    Corner corner;
    corner.origin = load3(scene->vertices[triangle.v0].position);
    corner.edge1 = load3(scene->vertices[triangle.v1].position) - corner.origin;
    corner.edge2 = load3(scene->vertices[triangle.v2].position) - corner.origin;
    return corner;
}

/// The point of the triangle `triangle_id` with the given weights of v1 and v2. `normal` gets the unit normal
/// of its front.
static inline float3 triangle_point(const SceneView* scene, uint triangle_id, float2 barycentrics,
                                    float3* normal) {
    const Corner corner = triangle_corner(scene, triangle_id);
    *normal = normalize(cross(corner.edge1, corner.edge2));
    return corner.origin + barycentrics.x * corner.edge1 + barycentrics.y * corner.edge2;
}

static inline float triangle_area(const SceneView* scene, uint triangle_id) {
    const Corner corner = triangle_corner(scene, triangle_id);
    return 0.5f * length(cross(corner.edge1, corner.edge2));
}

/// Radiance that a surface sends back along a ray that met it. Only the front emits.
static inline float3 emitted_radiance(const SceneView* scene, const SurfaceHit* hit) {
    return hit->front ? look_up(scene, &scene->materials[hit->material].emission, hit).color : (float3)(0.0f);
}

/// Radiance that the front of an emissive triangle sends from the point with the given weights of v1 and v2.
static inline float3 triangle_radiance(const SceneView* scene, uint triangle_id, float2 barycentrics) {
    const global Parameter* emission = &scene->materials[scene->triangles[triangle_id].material].emission;
    if (emission->texture < 0) {
        return load3(emission->value);
    }
    const SurfaceHit point =
        surface_at(scene, triangle_id, barycentrics, (float3)(0.0f), (float3)(0.0f, 0.0f, 1.0f), true);
    return look_up(scene, emission, &point).color;
}

/// Weights of v1 and v2 where a ray from x meets the triangle's plane, moved into the triangle if rounding
/// has left them outside.
static inline float2 met_barycentrics(const Corner* corner, float3 x, float3 direction) {
    const float3 across = cross(direction, corner->edge2);
    const float3 from_corner = x - corner->origin;
    const float inverse = 1.0f / dot(corner->edge1, across);
    const float v1 = clamp(dot(from_corner, across) * inverse, 0.0f, 1.0f);
    const float v2 = dot(direction, cross(from_corner, corner->edge1)) * inverse;
    return (float2)(v1, clamp(v2, 0.0f, 1.0f - v1));
}

/// A direction from x to a point of a triangle: uniform over the solid angle, or over the area where that is
/// small.
typedef struct TriangleSample {
    float3 direction;     // unit
    float2 barycentrics;  // weights of v1 and v2
    float pdf;            // per steradian; 0 where x does not lie in front
} TriangleSample;

static inline TriangleSample sample_triangle(const SceneView* scene, uint triangle_id, float3 x, float2 u) {
    const Corner corner = triangle_corner(scene, triangle_id);
    const float3 across = cross(corner.edge1, corner.edge2);
    const float double_area = length(across);
    TriangleSample sample;
    const float3 normal = across / double_area;
    const SphericalTriangle seen = seen_triangle(corner.origin, corner.edge1, corner.edge2, x);
    if (seen.solid_angle >= MIN_SOLID_ANGLE) {
        sample.direction = sample_spherical_triangle(&seen, u);
        sample.barycentrics = met_barycentrics(&corner, x, sample.direction);
        sample.pdf = 1.0f / seen.solid_angle;
        return sample;
    }
    sample.barycentrics = square_to_triangle(u);
    const float3 to_point =
        corner.origin + sample.barycentrics.x * corner.edge1 + sample.barycentrics.y * corner.edge2 - x;
    const float squared = dot(to_point, to_point);
    sample.direction = squared > 0.0f ? to_point * rsqrt(squared) : -normal;
    const float cosine = -dot(normal, sample.direction);
    sample.pdf = cosine > 0.0f && double_area > 0.0f ? 2.0f * squared / (cosine * double_area) : 0.0f;
    return sample;
}

/// The density of sample_triangle() in a direction in which a ray from x met the front of the triangle at the
/// distance t, at an angle of the given cosine.
static inline float triangle_pdf(const SceneView* scene, uint triangle_id, float3 x, float t, float cosine) {
    const Corner corner = triangle_corner(scene, triangle_id);
    const SphericalTriangle seen = seen_triangle(corner.origin, corner.edge1, corner.edge2, x);
    return seen.solid_angle >= MIN_SOLID_ANGLE
               ? 1.0f / seen.solid_angle
               : 2.0f * t * t / (cosine * length(cross(corner.edge1, corner.edge2)));
}

#endif
