// SPDX-License-Identifier: Apache-2.0
// Convex polygons of few vertices: clipping by half-spaces and distance from the origin.
#ifndef NEARLIGHT_LIB_POLYGON
#define NEARLIGHT_LIB_POLYGON

#define NEARLIGHT_POLYGON_MAX 9  // a triangle clipped six times

typedef struct Polygon {
    float3 vertices[NEARLIGHT_POLYGON_MAX];
    uint count;  // 0: empty
} Polygon;

/// Keeps the part of the polygon where dot(normal, p) + offset ≥ 0. [Sutherland & Hodgman 1974]
static inline void clip_polygon(Polygon* polygon, float3 normal, float offset) {
    // Most triangles lie on one side of a plane.
    uint inside = 0;
    for (uint i = 0; i < polygon->count; ++i) {
        inside += dot(normal, polygon->vertices[i]) + offset >= 0.0f ? 1 : 0;
    }
    if (inside == 0 || inside == polygon->count) {
        polygon->count = inside;
        return;
    }
    Polygon clipped;
    clipped.count = 0;
    float3 from = polygon->vertices[polygon->count - 1];
    float from_height = dot(normal, from) + offset;
    for (uint i = 0; i < polygon->count; ++i) {
        const float3 to = polygon->vertices[i];
        const float to_height = dot(normal, to) + offset;
        // Rounding may make a sliver seem to cross more than twice; the bound keeps that harmless.
        if ((from_height >= 0.0f) != (to_height >= 0.0f) && clipped.count < NEARLIGHT_POLYGON_MAX) {
            clipped.vertices[clipped.count++] =
                from + (to - from) * (from_height / (from_height - to_height));
        }
        if (to_height >= 0.0f && clipped.count < NEARLIGHT_POLYGON_MAX) {
            clipped.vertices[clipped.count++] = to;
        }
        from = to;
        from_height = to_height;
    }
    *polygon = clipped;
}

/// Squared distance from the origin to the edge from a to b.
static inline float squared_distance_to_edge(float3 a, float3 b) {
    const float3 edge = b - a;
    const float squared = dot(edge, edge);
    const float t = squared > 0.0f ? clamp(-dot(a, edge) / squared, 0.0f, 1.0f) : 0.0f;
    const float3 nearest = a + t * edge;
    return dot(nearest, nearest);
}

/// Squared distance from the origin to the polygon; infinite if the polygon is empty. `normal` is normal to
/// its plane and may have any length. Where it is zero, only the edges count.
static inline float squared_distance_to_polygon(const Polygon* polygon, float3 normal) {
    float nearest = INFINITY;
    bool left_of_all = true;
    bool right_of_all = true;
    for (uint i = 0; i < polygon->count; ++i) {
        const float3 a = polygon->vertices[i];
        const float3 b = polygon->vertices[i + 1 == polygon->count ? 0 : i + 1];
        nearest = fmin(nearest, squared_distance_to_edge(a, b));
        const float side = dot(cross(a, b), normal);
        left_of_all = left_of_all && side >= 0.0f;
        right_of_all = right_of_all && side <= 0.0f;
    }
    const float squared = dot(normal, normal);
    if (polygon->count >= 3 && squared > 0.0f && (left_of_all || right_of_all)) {
        const float height = dot(polygon->vertices[0], normal);
        nearest = fmin(nearest, height * height / squared);
    }
    return nearest;
}

#endif
