// SPDX-License-Identifier: Apache-2.0
// The part of a triangle on which points of the close range can lie. Points are placed there only, because a
// floor or the grounds around a house may be a hundred times as large as what the camera sees of them nearby.
#ifndef NEARLIGHT_LIB_CLOSE_PART
#define NEARLIGHT_LIB_CLOSE_PART

#include "lib/math.cl"
#include "lib/polygon.cl"
#include "lib/sampling.cl"

/// A margin relative to the size of coordinates. It is more than rounding can move a point by.
#define ROUNDING_MARGIN 4e-6f

/// How far (m) rounding can move points of a triangle with these corners against the planes of the close
/// range.
static inline float close_margin(const global CloseRange* close_range, float3 a, float3 b, float3 c) {
    const float3 origin = load3(close_range->origin);
    const float3 reach = fmax(fmax(fabs(a), fabs(b)), fmax(fabs(c), fabs(origin)));
    return ROUNDING_MARGIN * max_component(reach);
}

/// The part of a triangle between the planes of the close range, with a plane across the view at the range in
/// the place of the sphere. It holds all points of the triangle that in_close_range() accepts. A vertex (u,
/// v, 0) of the polygon is the point a + u · (b − a) + v · (c − a).
static inline Polygon close_part(const global CloseRange* close_range, float3 a, float3 b, float3 c) {
    const float3 origin = load3(close_range->origin);
    const float margin = close_margin(close_range, a, b, c);
    Polygon part;
    part.vertices[0] = (float3)(0.0f, 0.0f, 0.0f);
    part.vertices[1] = (float3)(1.0f, 0.0f, 0.0f);
    part.vertices[2] = (float3)(0.0f, 1.0f, 0.0f);
    part.count = 3;
    for (int i = 0; i < 6; ++i) {
        const global float* plane = close_range->planes[min(i, 4)];
        const float3 forward = (float3)(plane[0], plane[1], plane[2]);
        const float3 normal = i < 5 ? forward : -forward;
        const float offset = i < 5 ? plane[3] : close_range->range;
        clip_polygon(&part, (float3)(dot(normal, b - a), dot(normal, c - a), 0.0f),
                     dot(normal, a - origin) + offset + margin);
    }
    return part;
}

/// Twice the signed area of the triangle of vertices 0, i + 1 and i + 2 of a polygon in a plane z = const.
static inline float fan_area(const Polygon* polygon, uint i) {
    const float3 s = polygon->vertices[i + 1] - polygon->vertices[0];
    const float3 t = polygon->vertices[i + 2] - polygon->vertices[0];
    return s.x * t.y - s.y * t.x;
}

/// The area of a part as a fraction of its triangle's.
static inline float part_of_area(const Polygon* part) {
    float sum = 0.0f;
    for (uint i = 0; i + 2 < part->count; ++i) {
        sum += fan_area(part, i);
    }
    return clamp(sum, 0.0f, 1.0f);
}

/// A uniform point of a part, (u, v).
static inline float2 square_to_part(const Polygon* part, float2 u) {
    float at = u.x * part_of_area(part);
    uint i = 0;
    while (i + 3 < part->count && at >= fan_area(part, i)) {
        at -= fan_area(part, i);
        ++i;
    }
    const float area = fan_area(part, i);
    const float rest = area > 0.0f ? clamp(at / area, 0.0f, 1.0f) : 0.5f;
    const float2 weights = square_to_triangle((float2)(rest, u.y));
    const float3 corner = part->vertices[0];
    return (corner + weights.x * (part->vertices[i + 1] - corner) +
            weights.y * (part->vertices[i + 2] - corner))
        .xy;
}

#endif
