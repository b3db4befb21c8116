// SPDX-License-Identifier: Apache-2.0
// Which functions are called rather than copied into their callers, on devices where copies cost most.
#ifndef NEARLIGHT_LIB_OUTLINED
#define NEARLIGHT_LIB_OUTLINED

/// Begins the definition of a long function that is called from several places. Drivers of GPUs copy each
/// function into all of its callers, and what follows whole paths would grow to millions of instructions, which
/// take minutes to compile and do not fit into the caches of a GPU. Drivers of CPUs must copy functions.
#if NEARLIGHT_OUTLINED
#define OUTLINED static __attribute__((noinline))
#else
#define OUTLINED static inline
#endif

#endif
