// SPDX-License-Identifier: Apache-2.0
// Maps from random numbers to table entries, directions and triangles.
#ifndef NEARLIGHT_LIB_SAMPLING
#define NEARLIGHT_LIB_SAMPLING

#include "lib/math.cl"

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

/// A direction about +Z with the density cosθ/π.
inline float3 square_to_cosine_hemisphere(float2 u) {
    const float r = sqrt(u.x);
    const float phi = 2.0f * M_PI_F * u.y;
    return (float3)(r * cos(phi), r * sin(phi), sqrt(fmax(0.0f, 1.0f - u.x)));
}

/// A direction within the angle of cosine `cos_max` about +Z, with the density 1 / (2π(1 − cos_max)). A
/// cosine of −1 gives the whole sphere.
inline float3 square_to_cone(float2 u, float cos_max) {
    const float z = 1.0f - u.x * (1.0f - cos_max);
    const float r = sqrt(fmax(0.0f, 1.0f - z * z));
    const float phi = 2.0f * M_PI_F * u.y;
    return (float3)(r * cos(phi), r * sin(phi), z);
}

/// Weights of v1 and v2 of a uniform point in a triangle. Neighbours stay neighbours, so that points that are
/// stratified in the square are stratified in the triangle. [Heitz, A Low-Distortion Map Between Triangle and
/// Square, 2019]
inline float2 square_to_triangle(float2 u) {
    return u.y > u.x ? (float2)(0.5f * u.x, u.y - 0.5f * u.x) : (float2)(u.x - 0.5f * u.y, 0.5f * u.y);
}

#endif
