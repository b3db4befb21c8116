// SPDX-License-Identifier: Apache-2.0
// The close range as a predicate on points. Patches, light tracing and the camera pass share it, so that
// what one of them leaves out is exactly what another supplies.
#ifndef NEARLIGHT_LIB_CLOSE_RANGE
#define NEARLIGHT_LIB_CLOSE_RANGE

#include "lib/math.cl"

static inline bool in_close_range(const global CloseRange* close_range, float3 p) {
    const float3 q = p - load3(close_range->origin);
    bool inside = true;
    for (int i = 0; i < 5; ++i) {
        const global float* plane = close_range->planes[i];
        inside = inside && plane[0] * q.x + plane[1] * q.y + plane[2] * q.z + plane[3] >= 0.0f;
    }
    return inside && dot(q, q) < close_range->range * close_range->range;
}

#endif
