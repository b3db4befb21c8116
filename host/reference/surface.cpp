// SPDX-License-Identifier: Apache-2.0
#include "host/reference/surface.h"

namespace nearlight::core {

Surface surface_at(const Scene& scene, const BvhHit& hit, Vec3 direction) {
    const Triangle& triangle = scene.triangles[hit.triangle];
    const Vertex& a = scene.vertices[triangle.v0];
    const Vertex& b = scene.vertices[triangle.v1];
    const Vertex& c = scene.vertices[triangle.v2];
    const float weight_a = 1.0f - hit.u - hit.v;

    Surface surface;
    surface.position = a.position * weight_a + b.position * hit.u + c.position * hit.v;
    surface.u = a.u * weight_a + b.u * hit.u + c.u * hit.v;
    surface.v = a.v * weight_a + b.v * hit.u + c.v * hit.v;
    surface.material = &scene.materials[triangle.material];

    const Vec3 normal = normalize(cross(b.position - a.position, c.position - a.position));
    surface.front = dot(normal, direction) < 0.0f;
    surface.geometric_normal = surface.front ? normal : -normal;

    const Vec3 interpolated = a.normal * weight_a + b.normal * hit.u + c.normal * hit.v;
    const Vec3 shading = length(interpolated) > 1e-6f ? normalize(interpolated) : normal;
    surface.shading_normal = dot(shading, surface.geometric_normal) < 0.0f ? -shading : shading;
    return surface;
}

}  // namespace nearlight::core
