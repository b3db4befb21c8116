// SPDX-License-Identifier: Apache-2.0
#include "host/reference/surface.h"

#include "host/scene/texture.h"

namespace nearlight::core {
namespace {

/// Solves (edge1, edge2) = (along_u, along_v) · (differences of texture coordinates) for the derivatives.
void set_derivatives(Surface& surface, const Vertex& a, const Vertex& b, const Vertex& c) {
    const float u1 = b.u - a.u;
    const float v1 = b.v - a.v;
    const float u2 = c.u - a.u;
    const float v2 = c.v - a.v;
    const float determinant = u1 * v2 - v1 * u2;
    const float inverse = 1.0f / determinant;
    const Vec3 edge1 = b.position - a.position;
    const Vec3 edge2 = c.position - a.position;
    surface.along_u = std::isfinite(inverse) ? (edge1 * v2 - edge2 * v1) * inverse : edge1;
    surface.along_v = std::isfinite(inverse) ? (edge2 * u1 - edge1 * u2) * inverse : edge2;
}

}  // namespace

Surface surface_at(const Scene& scene, const BvhHit& hit, Vec3 direction) {
    const Triangle& triangle = scene.triangles[hit.triangle];
    const Vertex& a = scene.vertices[triangle.v0];
    const Vertex& b = scene.vertices[triangle.v1];
    const Vertex& c = scene.vertices[triangle.v2];
    const float weight_a = 1.0f - hit.u - hit.v;

    Surface surface;
    surface.position = a.position * weight_a + b.position * hit.u + c.position * hit.v;
    surface.corners = {a.position, b.position, c.position};
    surface.u = a.u * weight_a + b.u * hit.u + c.u * hit.v;
    surface.v = a.v * weight_a + b.v * hit.u + c.v * hit.v;
    surface.material = &scene.materials[triangle.material];
    set_derivatives(surface, a, b, c);
    if (!scene.vertex_colors.empty()) {
        surface.vertex_color = scene.vertex_colors[triangle.v0] * weight_a +
                               scene.vertex_colors[triangle.v1] * hit.u +
                               scene.vertex_colors[triangle.v2] * hit.v;
    }

    for (std::size_t i = 0; i < 2 && !scene.second_uvs.empty(); ++i) {
        surface.second_uv[i] = scene.second_uvs[triangle.v0][i] * weight_a +
                               scene.second_uvs[triangle.v1][i] * hit.u +
                               scene.second_uvs[triangle.v2][i] * hit.v;
    }

    const Vec3 normal = normalize(cross(b.position - a.position, c.position - a.position));
    surface.front = dot(normal, direction) < 0.0f;
    surface.geometric_normal = surface.front ? normal : -normal;

    const Vec3 interpolated = a.normal * weight_a + b.normal * hit.u + c.normal * hit.v;
    surface.front_normal = length(interpolated) > 1e-6f ? normalize(interpolated) : normal;
    return surface;
}

Vec3 value_at(const Scene& scene, const Surface& surface, const Parameter& parameter) {
    return parameter_value(scene, parameter, surface.u, surface.v, surface.vertex_color, surface.second_uv);
}

}  // namespace nearlight::core
