// SPDX-License-Identifier: Apache-2.0
// Maps from random numbers to table entries, directions and triangles.
#ifndef NEARLIGHT_LIB_SAMPLING
#define NEARLIGHT_LIB_SAMPLING

#include "lib/angle.cl"
#include "lib/math.cl"

/// The smallest index with u < cdf[index], or the last one if rounding leaves u above all entries.
static inline uint search_cdf(const global float* cdf, uint count, float u) {
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

/// The probability of an entry of a cumulative distribution.
static inline float step_of_cdf(const global float* cdf, uint index) {
    return index == 0 ? cdf[0] : cdf[index] - cdf[index - 1];
}

/// An entry of a cumulative distribution that a number has selected.
typedef struct CdfStep {
    uint index;
    float probability;
    float within;  // where in the entry's part the number lies, uniform in [0, 1)
} CdfStep;

static inline CdfStep choose_step(const global float* cdf, uint count, float u) {
    CdfStep step;
    step.index = search_cdf(cdf, count, u);
    step.probability = step_of_cdf(cdf, step.index);
    const float low = cdf[step.index] - step.probability;
    step.within = clamp((u - low) / fmax(step.probability, 1e-20f), 0.0f, 0x1.fffffep-1f);
    return step;
}

/// A direction about +Z with the density cosθ/π.
static inline float3 square_to_cosine_hemisphere(float2 u) {
    return (float3)(sqrt(u.x) * circle_point(u.y), sqrt(fmax(0.0f, 1.0f - u.x)));
}

/// 1 − cosine of the angle below 90° whose squared sine is given, without the loss of digits that small
/// angles would suffer.
static inline float cone_height(float squared_sine) {
    return squared_sine / (1.0f + sqrt(fmax(1.0f - squared_sine, 0.0f)));
}

/// The direction at an angle to +Z whose cosine is 1 − `height`, `turns` around it. Heights tell small angles
/// apart, which cosines do not.
static inline float3 cone_direction(float height, float turns) {
    return (float3)(sqrt(height * fmax(2.0f - height, 0.0f)) * circle_point(turns), 1.0f - height);
}

/// A direction within an angle about +Z whose cosine is 1 − `height`, with the density 1 / (2π·height). A
/// height of 2 gives the whole sphere.
static inline float3 square_to_cap(float2 u, float height) {
    return cone_direction(height * u.x, u.y);
}

/// Weights of v1 and v2 of a uniform point in a triangle. Neighbours stay neighbours, so that points that are
/// stratified in the square are stratified in the triangle. [Heitz, A Low-Distortion Map Between Triangle and
/// Square, 2019]
static inline float2 square_to_triangle(float2 u) {
    return u.y > u.x ? (float2)(0.5f * u.x, u.y - 0.5f * u.x) : (float2)(u.x - 0.5f * u.y, 0.5f * u.y);
}

#endif
