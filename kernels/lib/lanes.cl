// SPDX-License-Identifier: Apache-2.0
// Operations on vectors of 4, 8 and 16 lanes for which drivers compile OpenCL's own functions badly.
#ifndef NEARLIGHT_LIB_LANES
#define NEARLIGHT_LIB_LANES

// These are functions of the compiler for a processor. Compilers for SPIR have them too, but drivers that
// read SPIR may not know what becomes of them: that of Mesa's rusticl ends the process.
#if defined(__has_builtin) && (defined(__x86_64__) || defined(__aarch64__))
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
// With mask registers, x86 compares lanes into a bit mask, which one instruction gives.
#if defined(__AVX512DQ__) && defined(__AVX512VL__)
#define LANES_MASK_REGISTERS
typedef int LanesInt4 __attribute__((__vector_size__(16)));
typedef int LanesInt8 __attribute__((__vector_size__(32)));
typedef int LanesInt16 __attribute__((__vector_size__(64)));
#endif

// On x86 without mask registers, one instruction collects the signs of floats.
#if !defined(LANES_MASK_REGISTERS) && defined(__AVX__)
#define LANES_SIGNS_OF_8
typedef float LanesFloat8 __attribute__((__vector_size__(32)));
#elif !defined(LANES_MASK_REGISTERS) && defined(__SSE__)
#define LANES_SIGNS_OF_4
typedef float LanesFloat4 __attribute__((__vector_size__(16)));
#endif

/// Marks functions that inner loops call. Left to itself, the compiler makes calls of large functions, and
/// every call spills registers.
#define LANES_INLINE static inline __attribute__((always_inline))

// Each of these comparisons compiles to one instruction; fmin() and fmax() have to handle NaN.
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

/// The bits that are set in any lane.
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

/// The index of the lowest bit that is set in `bits`, which must not be 0. OpenCL has ctz() only from version
/// 2.0 on, and clz() takes three instructions, for which the next load has to wait.
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

/// Prefetches the four cache lines from `at` on.
LANES_INLINE void prefetch_lines(const global void* at) {
#ifdef LANES_PREFETCH
    __builtin_prefetch(at);
    __builtin_prefetch((const global char*)at + 64);
    __builtin_prefetch((const global char*)at + 128);
    __builtin_prefetch((const global char*)at + 192);
#else
    prefetch((const global char*)at, 256);
#endif
}

#endif
