// SPDX-License-Identifier: Apache-2.0
// Random and quasi-random numbers without state. Each is a function of what it is used for, so that no result
// depends on the order in which work-items run.
#ifndef NEARLIGHT_LIB_RANDOM
#define NEARLIGHT_LIB_RANDOM

/// Four independent random words for a key. [Jarzynski & Olano, Hash Functions for GPU Rendering, JCGT 2020:
/// pcg4d]
static inline uint4 random_uint4(uint4 key) {
    uint4 v = key * 1664525u + 1013904223u;
    v.x += v.y * v.w;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v.w += v.y * v.z;
    v ^= v >> 16u;
    v.x += v.y * v.w;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v.w += v.y * v.z;
    return v;
}

/// The number in [0, 1) that random bits stand for.
static inline float to_unit_float(uint bits) {
    return (float)(bits >> 8) * 0x1p-24f;
}

static inline uint reverse_bits(uint x) {
    x = ((x & 0xaaaaaaaau) >> 1) | ((x & 0x55555555u) << 1);
    x = ((x & 0xccccccccu) >> 2) | ((x & 0x33333333u) << 2);
    x = ((x & 0xf0f0f0f0u) >> 4) | ((x & 0x0f0f0f0fu) << 4);
    x = ((x & 0xff00ff00u) >> 8) | ((x & 0x00ff00ffu) << 8);
    return (x >> 16) | (x << 16);
}

/// Owen scrambling by hash: a random permutation of the binary tree of [0, 1).
/// [Laine & Karras 2011; Burley, Practical Hash-based Owen Scrambling, JCGT 2020]
static inline uint owen_scramble(uint x, uint seed) {
    x = reverse_bits(x);
    x ^= x * 0x3d20adeau;
    x += seed;
    x *= (seed >> 16) | 1u;
    x ^= x * 0x05526c56u;
    x ^= x * 0x53a22864u;
    return reverse_bits(x);
}

/// Second coordinate of the (0, 2)-sequence of Sobol' from the first, which is reverse_bits(index). Its
/// matrix is Pascal's triangle modulo 2, where the binomial (k, j) is odd if all bits of j are set in k. Each
/// bit of a position is therefore a step of its own.
static inline uint sobol_second(uint first) {
    first ^= (first << 1) & 0xaaaaaaaau;
    first ^= (first << 2) & 0xccccccccu;
    first ^= (first << 4) & 0xf0f0f0f0u;
    first ^= (first << 8) & 0xff00ff00u;
    return first ^ (first << 16);
}

/// Point `index` of a randomised (0, 2)-sequence. The sequence is shuffled and scrambled anew for each
/// `dimension`, so that dimensions are independent and any number of them can be combined.
static inline float2 sample_2d(uint index, uint dimension, uint seed) {
    const uint4 keys = random_uint4((uint4)(dimension, seed, 0x9e3779b9u, 0x7f4a7c15u));
    const uint first = reverse_bits(owen_scramble(index, keys.x));
    return (float2)(to_unit_float(owen_scramble(first, keys.y)),
                    to_unit_float(owen_scramble(sobol_second(first), keys.z)));
}

#endif
