// SPDX-License-Identifier: Apache-2.0
// Vectors of 4, 8 and 16 lanes: what OpenCL C leaves to drivers that do it badly.
#ifndef NEARLIGHT_LIB_LANES
#define NEARLIGHT_LIB_LANES

#ifdef __has_builtin
#if __has_builtin(__builtin_reduce_or)
#define LANES_REDUCE_OR
#endif
#if __has_builtin(__builtin_prefetch)
#define LANES_PREFETCH
#endif
#if __has_builtin(__builtin_ctz)
#define LANES_TRAILING_ZEROS
#endif
#endif
// x86 with mask registers: a comparison's result is a number already.
#if defined(__AVX512DQ__) && defined(__AVX512VL__)
#define LANES_MASK_REGISTERS
typedef int LanesInt4 __attribute__((__vector_size__(16)));
typedef int LanesInt8 __attribute__((__vector_size__(32)));
typedef int LanesInt16 __attribute__((__vector_size__(64)));
#endif

// x86 without them: an instruction gathers the signs of floats.
#if !defined(LANES_MASK_REGISTERS) && defined(__AVX__)
#define LANES_SIGNS_OF_8
typedef float LanesFloat8 __attribute__((__vector_size__(32)));
#elif !defined(LANES_MASK_REGISTERS) && defined(__SSE__)
#define LANES_SIGNS_OF_4
typedef float LanesFloat4 __attribute__((__vector_size__(16)));
#endif

/// For what inner loops call: left to itself the compiler makes calls of large functions, and every call
/// spills.
#define LANES_INLINE inline __attribute__((always_inline))

// The spelled-out comparisons compile to one instruction each; fmin() and fmax() have to look after NaN.
LANES_INLINE float16 min16(float16 a, float16 b) {
    return a < b ? a : b;
}
LANES_INLINE float16 max16(float16 a, float16 b) {
    return a > b ? a : b;
}
LANES_INLINE float8 min8(float8 a, float8 b) {
    return a < b ? a : b;
}
LANES_INLINE float8 max8(float8 a, float8 b) {
    return a > b ? a : b;
}

/// All bits that are set in some lane.
LANES_INLINE uint any_bits8(int8 bits) {
#if defined(LANES_REDUCE_OR)
    return (uint)__builtin_reduce_or(bits);
#else
    const int4 a = bits.lo | bits.hi;
    const int2 b = a.lo | a.hi;
    return (uint)(b.x | b.y);
#endif
}

/// A number with bit i set where lane i is −1.
LANES_INLINE uint lane_bits8(int8 mask) {
#if defined(LANES_MASK_REGISTERS)
    return (uint)__builtin_ia32_cvtd2mask256((LanesInt8)mask) & 0xffu;
#elif defined(LANES_SIGNS_OF_8)
    return (uint)__builtin_ia32_movmskps256((LanesFloat8)mask);
#elif defined(LANES_SIGNS_OF_4)
    return (uint)__builtin_ia32_movmskps((LanesFloat4)mask.lo) |
           (uint)__builtin_ia32_movmskps((LanesFloat4)mask.hi) << 4;
#else
    return any_bits8(mask & (int8)(1, 2, 4, 8, 16, 32, 64, 128));
#endif
}
LANES_INLINE uint lane_bits4(int4 mask) {
#if defined(LANES_MASK_REGISTERS)
    return (uint)__builtin_ia32_cvtd2mask128((LanesInt4)mask) & 0xfu;
#else
    return lane_bits8((int8)(mask, (int4)0));
#endif
}
LANES_INLINE uint lane_bits16(int16 mask) {
#if defined(LANES_MASK_REGISTERS)
    return (uint)__builtin_ia32_cvtd2mask512((LanesInt16)mask) & 0xffffu;
#elif defined(LANES_SIGNS_OF_8) || defined(LANES_SIGNS_OF_4)
    return lane_bits8(mask.lo) | lane_bits8(mask.hi) << 8;
#else
    return any_bits8((mask.lo & (int8)(1, 2, 4, 8, 16, 32, 64, 128)) |
                     (mask.hi & (int8)(256, 512, 1024, 2048, 4096, 8192, 16384, 32768)));
#endif
}

/// −1 in the lanes whose bits are set.
LANES_INLINE int16 lanes_of(uint bits) {
    const int16 lane = (int16)(1, 2, 4, 8, 16, 32, 64, 128, 256, 512, 1024, 2048, 4096, 8192, 16384, 32768);
    return ((int16)(int)bits & lane) != 0;
}

/// Where the lowest bit is; there must be one. (OpenCL has ctz() from 2.0 on; clz() takes three instructions,
/// and what is loaded next waits for them.)
LANES_INLINE uint lowest_bit(uint bits) {
#ifdef LANES_TRAILING_ZEROS
    return (uint)__builtin_ctz(bits);
#else
    return 31 - clz(bits & -bits);
#endif
}

LANES_INLINE float16 reciprocal16(float16 d) {
    const float16 tiny = (float16)1e-20f;
    return 1.0f / (fabs(d) < tiny ? copysign(tiny, d) : d);
}

/// Asks for the first four cache lines of what lies at `at`.
LANES_INLINE void prefetch_lines(const global void* at) {
#ifdef LANES_PREFETCH
    __builtin_prefetch(at);
    __builtin_prefetch((const global char*)at + 64);
    __builtin_prefetch((const global char*)at + 128);
    __builtin_prefetch((const global char*)at + 192);
#endif
}

#endif
