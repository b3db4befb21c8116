// SPDX-License-Identifier: Apache-2.0
// Which triangles reach into the close range, with their areas and centroids. A triangle reaches into it if
// some point of it lies in the view frustum and nearer to the camera than the range. The triangle is clipped
// by the five planes, and the nearest point of what is left decides, not the centroid. [paper section 3:
// classification]
//
// The answer errs towards "yes", by a margin as large as the rounding of in_close_range() can be, so that no
// point that passes that test lies on a triangle that was left out. Triangles without a Lambertian part carry
// no VPLs and are left out, and so are triangles without area.
//
// Memory: arrays of the scene as in lib/scene.cl; one flag and one area (m²) for each triangle: that of the
// whole triangle, or of its part in the close range (lib/close_part.cl) where the policy decides point by
// point (whole_triangles = 0). One work-item for each triangle; work-group size: any.

#include "lib/close_part.cl"
#include "lib/math.cl"

static inline bool carries_vpls(const global Material* material) {
    return (material->flags & (NEARLIGHT_MATERIAL_DIFFUSE_FRONT | NEARLIGHT_MATERIAL_DIFFUSE_BACK)) != 0;
}

static inline bool reaches_into(const global CloseRange* close_range, float3 a, float3 b, float3 c,
                                float3 normal) {
    const float3 origin = load3(close_range->origin);
    const float margin = close_margin(close_range, a, b, c);
    // Positions and planes are relative to the camera, so that numbers are small where accuracy matters.
    Polygon polygon;
    polygon.vertices[0] = a - origin;
    polygon.vertices[1] = b - origin;
    polygon.vertices[2] = c - origin;
    polygon.count = 3;
    for (int i = 0; i < 5; ++i) {
        const global float* plane = close_range->planes[i];
        clip_polygon(&polygon, (float3)(plane[0], plane[1], plane[2]), plane[3] + margin);
    }
    const float range = close_range->range + margin;
    return squared_distance_to_polygon(&polygon, normal) < range * range;
}

kernel void classify_triangles(const global Vertex* restrict vertices,
                               const global Triangle* restrict triangles,
                               const global Material* restrict materials,
                               const global CloseRange* restrict close_range, uint whole_triangles,
                               global uint* restrict flags, global float* restrict areas,
                               uint triangle_count) {
    const uint i = (uint)get_global_id(0);
    if (i >= triangle_count) {
        return;
    }
    const Triangle triangle = triangles[i];
    const float3 a = load3(vertices[triangle.v0].position);
    const float3 b = load3(vertices[triangle.v1].position);
    const float3 c = load3(vertices[triangle.v2].position);
    const float3 normal = cross(b - a, c - a);
    const float area = 0.5f * sqrt(dot(normal, normal));
    const bool is_close = area > 0.0f && carries_vpls(materials + triangle.material) &&
                          reaches_into(close_range, a, b, c, normal);
    float part = 1.0f;
    if (is_close && !whole_triangles) {
        const Polygon close = close_part(close_range, a, b, c);
        part = part_of_area(&close);
    }
    areas[i] = area * part;
    flags[i] = is_close;
}

/// Sets centroids[i] to the centroid of triangle ids[i].
kernel void triangle_centroids(const global Vertex* restrict vertices,
                               const global Triangle* restrict triangles, const global uint* restrict ids,
                               global Vec3* restrict centroids, uint count) {
    const uint i = (uint)get_global_id(0);
    if (i >= count) {
        return;
    }
    const Triangle triangle = triangles[ids[i]];
    centroids[i] = store3((load3(vertices[triangle.v0].position) + load3(vertices[triangle.v1].position) +
                           load3(vertices[triangle.v2].position)) *
                          (1.0f / 3.0f));
}
