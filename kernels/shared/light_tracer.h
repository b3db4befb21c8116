// SPDX-License-Identifier: Apache-2.0
// One launch of light_tracer.cl.
#ifndef NEARLIGHT_SHARED_LIGHT_TRACER_H
#define NEARLIGHT_SHARED_LIGHT_TRACER_H

#include "shared/types.h"

#ifdef __cplusplus
namespace nearlight::core {
#endif

// Which deposits in the close range a policy keeps (docs/method.md).
#define NEARLIGHT_KEEP_ALL 0u              // complete, and samplers without a close range
#define NEARLIGHT_KEEP_INDIRECT_INSIDE 1u  // partition: inside the close range, depth 2 and more
#define NEARLIGHT_KEEP_OUTSIDE 2u          // paper: nothing inside the close range

/// Which walks a launch makes, and what becomes of them.
typedef struct LightTracerParams {
    uint whole_triangles;              // 1: selected triangles lie in the close range as a whole
    uint keep;                         // NEARLIGHT_KEEP_…
    uint first_walk, walk_count;       // of this launch
    uint bounce_count;                 // max deposits of a walk
    uint all_walks;                    // of all launches
    float min_survival, max_survival;  // bounds of the part of the walks that a surface sends on
    float absorption_shift;            // uniform in [0, 1), the same for all launches
    uint seed;
    uint pad0, pad1;
} LightTracerParams;

#ifdef __cplusplus
NEARLIGHT_CHECK_SHARED(LightTracerParams, 48);
}  // namespace nearlight::core
#endif

#endif
