// SPDX-License-Identifier: Apache-2.0
// Splits an array into runs, one for each work-item: long ones on CPUs, short ones on GPUs.
// host/stages/runs.h has the same arithmetic.
#ifndef NEARLIGHT_LIB_RUN
#define NEARLIGHT_LIB_RUN

/// The first element of run `run`, which is also the end of the run before it. It is never beyond `count`.
static inline uint run_begin(uint run, uint run_size, uint count) {
    return (uint)min((ulong)run * run_size, (ulong)count);
}

#endif
