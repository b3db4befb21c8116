// SPDX-License-Identifier: Apache-2.0
// Which functions are called rather than copied into their callers, on devices where copies cost most.
#ifndef NEARLIGHT_LIB_OUTLINED
#define NEARLIGHT_LIB_OUTLINED

/// Begins the definition of a long function that has several callers, or one whose registers would spill with
/// it. Left to themselves, drivers of GPUs copy such functions into all of their callers: what follows whole
/// paths grows to megabytes of code, which take minutes to compile and do not fit into the caches of a GPU.
/// Drivers of CPUs must copy functions.
#if NEARLIGHT_OUTLINED
#define OUTLINED static __attribute__((noinline))
#else
#define OUTLINED static inline
#endif

#endif
