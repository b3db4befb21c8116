// SPDX-License-Identifier: Apache-2.0
// Prefix sums by reduce-then-scan: sum each run, scan the sums (the host recurses), then scan each run from
// its offset. No work-item waits for another, so the scan needs no forward progress between work-groups, and
// integer sums make the result the same on every device. [paper section 3: the area prefix sum f]
//
// Memory: arrays of `count` SCAN_TYPE; `run_sums` and `run_offsets` hold one entry for each run. `input`
// and `output` of scan_runs may be the same array, which is why they are not `restrict`. Work-group size:
// any.

#include "lib/run.cl"

#ifndef SCAN_TYPE
#define SCAN_TYPE uint
#endif

/// Work-item i sums run i.
kernel void scan_reduce(const global SCAN_TYPE* restrict input, global SCAN_TYPE* restrict run_sums,
                        uint count, uint run_size, uint run_count) {
    const uint run = (uint)get_global_id(0);
    if (run >= run_count) {
        return;
    }
    const uint end = run_begin(run + 1, run_size, count);
    SCAN_TYPE sum = 0;
    for (uint i = run_begin(run, run_size, count); i < end; ++i) {
        sum += input[i];
    }
    run_sums[run] = sum;
}

/// Work-item i scans run i, starting from run_offsets[i]. If there is only one run, it starts from 0 and
/// does not read run_offsets. The last work-item writes the sum of everything to `total`.
kernel void scan_runs(const global SCAN_TYPE* input, const global SCAN_TYPE* run_offsets,
                      global SCAN_TYPE* output, global SCAN_TYPE* total, uint count, uint run_size,
                      uint run_count, uint inclusive) {
    const uint run = (uint)get_global_id(0);
    if (run >= run_count) {
        return;
    }
    const uint end = run_begin(run + 1, run_size, count);
    SCAN_TYPE sum = run_count > 1 ? run_offsets[run] : (SCAN_TYPE)0;
    for (uint i = run_begin(run, run_size, count); i < end; ++i) {
        const SCAN_TYPE value = input[i];
        output[i] = inclusive ? sum + value : sum;
        sum += value;
    }
    if (run == run_count - 1) {
        *total = sum;
    }
}
