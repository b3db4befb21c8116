// SPDX-License-Identifier: Apache-2.0
// The close range as a predicate on points. Placement, light tracing and the camera pass share it, so that
// what one of them leaves out is exactly what another supplies.
#ifndef NEARLIGHT_LIB_CLOSE_RANGE
#define NEARLIGHT_LIB_CLOSE_RANGE

#include "lib/math.cl"

inline bool in_close_range(const global CloseRange* region, float3 p) {
    bool inside = true;
    for (int i = 0; i < 5; ++i) {
        const global float* plane = region->planes[i];
        inside = inside && plane[0] * p.x + plane[1] * p.y + plane[2] * p.z + plane[3] >= 0.0f;
    }
    const float3 from_camera = p - load3(region->origin);
    return inside && dot(from_camera, from_camera) < region->range * region->range;
}

#endif
