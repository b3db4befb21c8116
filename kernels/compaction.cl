// SPDX-License-Identifier: Apache-2.0
// Stable compaction: the indices of the flags that are set, in ascending order, and the gathering of elements
// by index. Between the first two kernels the host scans the counts of the runs. [paper section 3: the
// triangles that are kept]
//
// Memory: `flags` holds `count` uint, and all but 0 count as set; `run_counts` holds one uint for each run;
// `indices` has room for every set flag. Work-group size: any.

#include "lib/run.cl"

/// Work-item i counts the set flags of run i.
kernel void compaction_count(const global uint* restrict flags, global uint* restrict run_counts, uint count,
                             uint run_size, uint run_count) {
    const uint run = (uint)get_global_id(0);
    if (run >= run_count) {
        return;
    }
    const uint end = run_begin(run + 1, run_size, count);
    uint set = 0;
    for (uint i = run_begin(run, run_size, count); i < end; ++i) {
        set += flags[i] != 0;
    }
    run_counts[run] = set;
}

/// Work-item i writes the indices of run i from run_offsets[i] on.
kernel void compaction_write(const global uint* restrict flags, const global uint* restrict run_offsets,
                             global uint* restrict indices, uint count, uint run_size, uint run_count) {
    const uint run = (uint)get_global_id(0);
    if (run >= run_count) {
        return;
    }
    const uint end = run_begin(run + 1, run_size, count);
    uint at = run_offsets[run];
    for (uint i = run_begin(run, run_size, count); i < end; ++i) {
        if (flags[i] != 0) {
            indices[at++] = i;
        }
    }
}

/// Sets gathered[i] to elements[indices[i]], for elements of `words` × 4 bytes. One work-item for each
/// element.
kernel void compaction_gather(const global uint* restrict elements, const global uint* restrict indices,
                              global uint* restrict gathered, uint words, uint count) {
    const uint i = (uint)get_global_id(0);
    if (i >= count) {
        return;
    }
    const global uint* restrict from = elements + (size_t)indices[i] * words;
    global uint* restrict to = gathered + (size_t)i * words;
    for (uint word = 0; word < words; ++word) {
        to[word] = from[word];
    }
}
