// SPDX-License-Identifier: Apache-2.0
// Directions to a triangle, uniform over the solid angle under which it is seen [Arvo, Stratified Sampling of
// Spherical Triangles, 1995]. Half angles take the place of the angles at the corners [after van Oosterom &
// Strackee, The Solid Angle of a Plane Triangle, 1983], and differences that of cosines near 1, so that
// single precision is enough for small triangles and thin ones.
#ifndef NEARLIGHT_LIB_LIGHT_SPHERICAL_TRIANGLE
#define NEARLIGHT_LIB_LIGHT_SPHERICAL_TRIANGLE

#include "lib/angle.cl"
#include "lib/math.cl"

/// A triangle seen from a point.
typedef struct SphericalTriangle {
    float3 v0, v1, v2;  // unit vectors to the corners
    float determinant;  // |det(v0, v1, v2)|
    float solid_angle;  // steradians; 0 where the point does not lie in front
} SphericalTriangle;

/// The triangle with the corner `a` and the edges from there to the second and third corner, seen from x.
static inline SphericalTriangle seen_triangle(float3 a, float3 edge1, float3 edge2, float3 x) {
    const float3 to_v0 = a - x;
    const float3 to_v1 = to_v0 + edge1;
    const float3 to_v2 = to_v0 + edge2;
    const float inverse0 = rsqrt(dot(to_v0, to_v0));
    const float inverse1 = rsqrt(dot(to_v1, to_v1));
    const float inverse2 = rsqrt(dot(to_v2, to_v2));
    SphericalTriangle seen;
    seen.v0 = to_v0 * inverse0;
    seen.v1 = to_v1 * inverse1;
    seen.v2 = to_v2 * inverse2;
    seen.determinant = -dot(seen.v0, cross(edge1, edge2)) * inverse1 * inverse2;
    const float denominator = 1.0f + dot(seen.v0, seen.v1) + dot(seen.v1, seen.v2) + dot(seen.v2, seen.v0);
    seen.solid_angle = seen.determinant > 0.0f && isfinite(seen.determinant)
                           ? 4.0f * M_PI_F * turns_of_point(denominator, seen.determinant)
                           : 0.0f;
    return seen;
}

/// A unit vector that is uniform over the solid angle, which must be greater than 0.
static inline float3 sample_spherical_triangle(const SphericalTriangle* seen, float2 u) {
    // The point q of the arc from v0 to v2 for which (v0, v1, q) has the share u.x of the solid angle: v0 is
    // mirrored at the direction `half_way` to q.
    const float2 turned = circle_point(seen->solid_angle * u.x * (0.25f / M_PI_F));
    const float3 half_way =
        (seen->determinant * turned.x - (dot(seen->v0, seen->v2) + dot(seen->v1, seen->v2)) * turned.y) *
            seen->v0 +
        ((1.0f + dot(seen->v0, seen->v1)) * turned.y) * seen->v2;
    const float squared = dot(half_way, half_way);
    const float3 q =
        squared > 0.0f ? half_way * (2.0f * dot(seen->v0, half_way) / squared) - seen->v0 : seen->v0;
    // On the arc from v1 to q, the cosine of the angle from v1 is uniform.
    const float3 chord = q - seen->v1;
    const float height = 0.5f * dot(chord, chord);
    const float t = sqrt(u.y * (2.0f - u.y * height) / fmax(2.0f - height, 1e-12f));
    return normalize(seen->v1 + t * chord + height * (t - u.y) * seen->v1);
}

#endif
