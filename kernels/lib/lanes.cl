// SPDX-License-Identifier: Apache-2.0
// Vectors of 8 and 16 lanes: what OpenCL C leaves to drivers that do it badly.
#ifndef NEARLIGHT_LIB_LANES
#define NEARLIGHT_LIB_LANES

#ifdef __has_builtin
#if __has_builtin(__builtin_reduce_or)
#define LANES_REDUCE_OR
#endif
#if __has_builtin(__builtin_prefetch)
#define LANES_PREFETCH
#endif
#endif

// The spelled-out comparisons compile to one instruction each; fmin() and fmax() have to look after NaN.
inline float16 min16(float16 a, float16 b) {
    return a < b ? a : b;
}
inline float16 max16(float16 a, float16 b) {
    return a > b ? a : b;
}
inline float8 min8(float8 a, float8 b) {
    return a < b ? a : b;
}
inline float8 max8(float8 a, float8 b) {
    return a > b ? a : b;
}

/// True if any lane is −1. Some drivers compile any() to a branch a lane pair.
inline bool any_lane(int16 mask) {
#ifdef LANES_REDUCE_OR
    return __builtin_reduce_or(mask) != 0;
#else
    const int8 a = mask.lo | mask.hi;
    const int4 b = a.lo | a.hi;
    const int2 c = b.lo | b.hi;
    return (c.x | c.y) != 0;
#endif
}

/// A number with bit i set where lane i is −1.
inline uint lane_bits(int8 mask) {
    const int8 bits = mask & (int8)(1, 2, 4, 8, 16, 32, 64, 128);
#ifdef LANES_REDUCE_OR
    return (uint)__builtin_reduce_or(bits);
#else
    const int4 a = bits.lo | bits.hi;
    const int2 b = a.lo | a.hi;
    return (uint)(b.x | b.y);
#endif
}

inline uint lowest_bit(uint bits) {
    return 31 - clz(bits & -bits);
}

inline float16 reciprocal16(float16 d) {
    const float16 tiny = (float16)1e-20f;
    return 1.0f / (fabs(d) < tiny ? copysign(tiny, d) : d);
}

/// Asks for the first three cache lines of what lies at `at`.
inline void prefetch_lines(const global void* at) {
#ifdef LANES_PREFETCH
    __builtin_prefetch(at);
    __builtin_prefetch((const global char*)at + 64);
    __builtin_prefetch((const global char*)at + 128);
#endif
}

#endif
