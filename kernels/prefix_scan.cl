// SPDX-License-Identifier: Apache-2.0
// Prefix sums by reduce-then-scan: sum each run, scan the sums (the host recurses), then scan each run from
// its offset. No work-item waits for another, so the scan needs no forward progress between work-groups, and
// integer sums make the result the same on every device. [paper section 3: the area prefix sum f]
//
// Memory: arrays of `count` SCAN_TYPE; `chunk_sums` and `chunk_offsets` hold one entry for each run. `input`
// and `output` of scan_chunks may be the same array, which is why they are not `restrict`. Work-group size:
// any.

#include "lib/chunk.cl"

#ifndef SCAN_TYPE
#define SCAN_TYPE uint
#endif

/// Work-item i sums run i.
kernel void scan_reduce(const global SCAN_TYPE* restrict input, global SCAN_TYPE* restrict chunk_sums,
                        uint count, uint chunk_size, uint chunk_count) {
    const uint chunk = (uint)get_global_id(0);
    if (chunk >= chunk_count) {
        return;
    }
    const uint end = chunk_begin(chunk + 1, chunk_size, count);
    SCAN_TYPE sum = 0;
    for (uint i = chunk_begin(chunk, chunk_size, count); i < end; ++i) {
        sum += input[i];
    }
    chunk_sums[chunk] = sum;
}

/// Work-item i scans run i, starting from chunk_offsets[i]. If there is only one run, it starts from 0 and
/// does not read chunk_offsets. The last work-item writes the sum of everything to `total`.
kernel void scan_chunks(const global SCAN_TYPE* input, const global SCAN_TYPE* chunk_offsets,
                        global SCAN_TYPE* output, global SCAN_TYPE* total, uint count, uint chunk_size,
                        uint chunk_count, uint inclusive) {
    const uint chunk = (uint)get_global_id(0);
    if (chunk >= chunk_count) {
        return;
    }
    const uint end = chunk_begin(chunk + 1, chunk_size, count);
    SCAN_TYPE sum = chunk_count > 1 ? chunk_offsets[chunk] : (SCAN_TYPE)0;
    for (uint i = chunk_begin(chunk, chunk_size, count); i < end; ++i) {
        const SCAN_TYPE value = input[i];
        output[i] = inclusive ? sum + value : sum;
        sum += value;
    }
    if (chunk == chunk_count - 1) {
        *total = sum;
    }
}
