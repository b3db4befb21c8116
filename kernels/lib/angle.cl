// SPDX-License-Identifier: Apache-2.0
// Angles in turns (1 is the whole circle), by polynomials. cos(), sin(), atan2() and acos() of OpenCL take
// any angle and round to the last bits, which costs several times as much on CPUs, and directions are sampled
// at each surface of each path.
#ifndef NEARLIGHT_LIB_ANGLE
#define NEARLIGHT_LIB_ANGLE

/// (cos, sin) of an angle of at most a million turns. The error is below 1e-7, and below 1e-6 of the sine of
/// a small angle.
static inline float2 circle_point(float turns) {
    const float quarter = floor(4.0f * turns + 0.5f);
    const float x = turns - 0.25f * quarter;  // from −1/8 to 1/8
    const float z = x * x;
    // Polynomials of least maximum error.
    const float sine =
        x * fma(fma(fma(fma(41.472950f, z, -76.697868f), z, 81.605202f), z, -41.3417016f), z, 6.28318548f);
    const float cosine =
        fma(fma(fma(fma(59.2204056f, z, -85.4428558f), z, 64.9393158f), z, -19.7392082f), z, 1.0f);
    const uint octant = (uint)(int)quarter & 3u;
    const float2 point = (octant & 1u) != 0 ? (float2)(-sine, cosine) : (float2)(cosine, sine);
    return (octant & 2u) != 0 ? -point : point;
}

/// The angle from the x axis to (x, y), from −1/2 to 1/2 turns; 0 at the origin. The error is below 5e-8, and
/// below 1e-6 of a small angle.
static inline float turns_of_point(float x, float y) {
    const float wide = fmax(fabs(x), fabs(y));
    const float t = wide > 0.0f ? fmin(fabs(x), fabs(y)) / wide : 0.0f;
    const float z = t * t;
    float series = fma(4.62109165e-4f, z, -2.59149913e-3f);
    series = fma(series, z, 6.84989244e-3f);
    series = fma(series, z, -1.19901886e-2f);
    series = fma(series, z, 1.69574320e-2f);
    series = fma(series, z, -2.26113517e-2f);
    series = fma(series, z, 3.18199322e-2f);
    series = fma(series, z, -5.30512668e-2f);
    series = fma(series, z, 0.159154937f);
    float turns = t * series;
    turns = fabs(y) > fabs(x) ? 0.25f - turns : turns;
    turns = x < 0.0f ? 0.5f - turns : turns;
    return y < 0.0f ? -turns : turns;
}

/// The angle whose cosine is given, from 0 to 1/2 turns. A cosine beyond ±1 counts as ±1. The error is below
/// 1e-7.
static inline float turns_of_cosine(float cosine) {
    const float x = fmin(fabs(cosine), 1.0f);
    float series = fma(-2.29416169e-4f, x, 1.15314084e-3f);
    series = fma(series, x, -2.83437658e-3f);
    series = fma(series, x, 4.98718925e-3f);
    series = fma(series, x, -8.00752622e-3f);
    series = fma(series, x, 1.41646687e-2f);
    series = fma(series, x, -3.41546391e-2f);
    series = fma(series, x, 0.25f);
    const float turns = sqrt(1.0f - x) * series;
    return cosine < 0.0f ? 0.5f - turns : turns;
}

#endif
