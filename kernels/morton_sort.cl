// SPDX-License-Identifier: Apache-2.0
// Order along the Morton curve: bounds and codes of points, then a stable radix sort of (key, value) pairs,
// least significant digit first, with 8 bits in a pass. A pass counts the digits of each run, the host scans
// the counts (all runs of digit 0, then all of digit 1, …), and each run moves its pairs to where the scan
// says. The sort uses integers only, so the order is the same on every device. [paper section 3: order of the
// triangles]
//
// Memory: `keys` and `values` hold `count` uint; `positions` has 256 counters for each run, with that of
// digit d and run r at d · run_count + r. Points are the first three floats of elements of `stride` floats.
// Work-group size: any.

#include "lib/math.cl"
#include "lib/morton.cl"
#include "lib/run.cl"

#define DIGIT_COUNT 256
#define DIGIT_OF(key, shift) (((key) >> (shift)) & (DIGIT_COUNT - 1))

static inline float3 load_point(const global float* restrict points, uint index, uint stride) {
    const global float* point = points + (size_t)index * stride;
    return (float3)(point[0], point[1], point[2]);
}

/// Work-item i finds the box of run i: six floats, minimum then maximum. Points that are not finite do not
/// count. A box without points is empty (minimum ∞, maximum −∞).
kernel void morton_bounds(const global float* restrict points, global float* restrict boxes, uint stride,
                          uint count, uint run_size, uint run_count) {
    const uint run = (uint)get_global_id(0);
    if (run >= run_count) {
        return;
    }
    const uint end = run_begin(run + 1, run_size, count);
    float3 low = (float3)(INFINITY);
    float3 high = (float3)(-INFINITY);
    for (uint i = run_begin(run, run_size, count); i < end; ++i) {
        const float3 point = load_point(points, i, stride);
        if (isfinite(point.x) && isfinite(point.y) && isfinite(point.z)) {
            low = fmin(low, point);
            high = fmax(high, point);
        }
    }
    vstore3(low, 2 * run, boxes);
    vstore3(high, 2 * run + 1, boxes);
}

/// Sets codes[i] to the Morton code of point i, and values[i] to i. One work-item for each point.
kernel void morton_codes(const global float* restrict points, global uint* restrict codes,
                         global uint* restrict values, uint stride, float min_x, float min_y, float min_z,
                         float cells_per_metre, uint count) {
    const uint i = (uint)get_global_id(0);
    if (i >= count) {
        return;
    }
    const float3 point = load_point(points, i, stride);
    codes[i] = morton_code((point - (float3)(min_x, min_y, min_z)) * cells_per_metre);
    values[i] = i;
}

/// Work-item i counts the digits of run i.
kernel void sort_count(const global uint* restrict keys, global uint* restrict positions, uint shift,
                       uint count, uint run_size, uint run_count) {
    const uint run = (uint)get_global_id(0);
    if (run >= run_count) {
        return;
    }
    uint counters[DIGIT_COUNT];
    for (uint digit = 0; digit < DIGIT_COUNT; ++digit) {
        counters[digit] = 0;
    }
    const uint end = run_begin(run + 1, run_size, count);
    for (uint i = run_begin(run, run_size, count); i < end; ++i) {
        ++counters[DIGIT_OF(keys[i], shift)];
    }
    for (uint digit = 0; digit < DIGIT_COUNT; ++digit) {
        positions[digit * run_count + run] = counters[digit];
    }
}

/// Work-item i moves the pairs of run i, in order.
kernel void sort_scatter(const global uint* restrict keys, const global uint* restrict values,
                         const global uint* restrict positions, global uint* restrict sorted_keys,
                         global uint* restrict sorted_values, uint shift, uint count, uint run_size,
                         uint run_count) {
    const uint run = (uint)get_global_id(0);
    if (run >= run_count) {
        return;
    }
    uint next[DIGIT_COUNT];
    for (uint digit = 0; digit < DIGIT_COUNT; ++digit) {
        next[digit] = positions[digit * run_count + run];
    }
    const uint end = run_begin(run + 1, run_size, count);
    for (uint i = run_begin(run, run_size, count); i < end; ++i) {
        const uint key = keys[i];
        const uint at = next[DIGIT_OF(key, shift)]++;
        sorted_keys[at] = key;
        sorted_values[at] = values[i];
    }
}
