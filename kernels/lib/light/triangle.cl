// SPDX-License-Identifier: Apache-2.0
// Points on triangles, and what an emissive one sends.
#ifndef NEARLIGHT_LIB_LIGHT_TRIANGLE
#define NEARLIGHT_LIB_LIGHT_TRIANGLE

#include "lib/sampling.cl"
#include "lib/scene.cl"

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

/// Radiance that a surface sends back along a ray that met it. Only the front emits.
inline float3 emitted_radiance(const SceneView* scene, const SurfaceHit* hit, float3 direction) {
    (void)direction;  // emission is alike in all directions
    return hit->front ? load3(scene->materials[hit->material].emission) : (float3)(0.0f);
}

/// Density per steradian at the distance √squared of a point that has the density `per_area` on a surface
/// whose normal has the given cosine.
inline float per_steradian(float per_area, float squared, float cosine) {
    return per_area * squared / cosine;
}

#endif
