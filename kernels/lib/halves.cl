// SPDX-License-Identifier: Apache-2.0
// How far apart the halves of a pixel's samples lie, by which variances are estimated. The first half of n
// samples has n / 2 of them, rounded down.
#ifndef NEARLIGHT_LIB_HALVES
#define NEARLIGHT_LIB_HALVES

/// The variance of the mean of `count` samples that are drawn one by one, for the sums over the halves; 0 for
/// a single sample. With a + b = n samples it is a·b/n² · (difference of the halves' means)².
static inline float variance_by_halves(float first, float second, uint count) {
    const float in_first = (float)(count / 2);
    const float in_second = (float)count - in_first;
    const float difference = first / in_first - second / in_second;
    const float share = in_first * in_second / ((float)count * (float)count);
    return count > 1 ? share * difference * difference : 0.0f;
}

#endif
