// SPDX-License-Identifier: Apache-2.0
// Which functions are called rather than copied into their callers.
#ifndef NEARLIGHT_LIB_OUTLINED
#define NEARLIGHT_LIB_OUTLINED

/// Begins the definition of a long function that has several callers, or one whose registers would spill with
/// it. Left to themselves, drivers copy such functions into their callers: what follows whole paths grows to
/// megabytes of code, which take minutes to compile on GPUs and do not fit into their caches.
#define OUTLINED static __attribute__((noinline))

/// Begins the definition of a function that CPUs call and GPUs may copy, such as the long body of a kernel:
/// PoCL puts what stands in a kernel itself into its code three times, once for each way to launch it.
#if NEARLIGHT_CPU
#define OUTLINED_ON_CPU OUTLINED
#else
#define OUTLINED_ON_CPU static inline
#endif

#endif
