// SPDX-License-Identifier: Apache-2.0
// The shaft from a VPL to the box around receivers: what holds all their segments.
#ifndef NEARLIGHT_LIB_SHAFT
#define NEARLIGHT_LIB_SHAFT

#include "lib/bvh_traverse.cl"
#include "lib/lanes.cl"

/// Bounds keep so far outside of what they bound, relatively: several roundings.
#define SHAFT_SLACK 4e-7f

/// Box around the receivers of a packet that are there.
typedef struct PacketBounds {
    float3 low, high;
} PacketBounds;

/// What holds all segments of a packet: at fraction t of its way each is within t·[low, high] of the origin.
typedef struct Shaft {
    float3 center, extent;        // of [low, high], the extent with slack
    float3 reach;                 // the greater of |low| and |high|
    float by_low[3], by_high[3];  // reciprocals of low and high
    uint straddles;               // 1: low and high differ in sign along some axis
    // If not:
    uint near[3];                 // which plane of a box comes first: 0 the lower, WIDE_UPPER the upper
    float by_near[3], by_far[3];  // what near and far planes are divided by, reciprocal
} Shaft;

// Floats from a lower plane of a WideNode to the upper one.
#define WIDE_UPPER (3 * NEARLIGHT_WIDE_CHILDREN)

/// What holds the segments from `origin` to everything within the bounds.
inline void make_shaft(Shaft* shaft, float3 origin, const PacketBounds* bounds) {
    const float3 low = bounds->low - origin;
    const float3 high = bounds->high - origin;
    shaft->center = 0.5f * (low + high);
    shaft->reach = fmax(fabs(low), fabs(high));
    shaft->extent = 0.5f * (high - low) + SHAFT_SLACK * shaft->reach;
    const float3 by_low3 = safe_reciprocal(low);
    const float3 by_high3 = safe_reciprocal(high);
    const float by_low[3] = {by_low3.x, by_low3.y, by_low3.z};
    const float by_high[3] = {by_high3.x, by_high3.y, by_high3.z};
    shaft->straddles = 0;
    for (uint axis = 0; axis < 3; ++axis) {
        const bool down = by_low[axis] < 0.0f;
        shaft->straddles |= down && by_high[axis] > 0.0f ? 1u : 0u;
        shaft->by_low[axis] = by_low[axis];
        shaft->by_high[axis] = by_high[axis];
        shaft->near[axis] = down ? WIDE_UPPER : 0;
        shaft->by_near[axis] = down ? by_low[axis] : by_high[axis];
        shaft->by_far[axis] = (down ? by_high[axis] : by_low[axis]) * (1.0f + SHAFT_SLACK);
    }
}

/// −1 in the lanes of children that the shaft may meet: those for which some t has t·high above the lower
/// plane and t·low below the upper one, on each axis. What this rejects, every segment misses.
inline int8 children_in_shaft(const Shaft* shaft, float3 from, const global WideNode* node) {
    const float origin[3] = {from.x, from.y, from.z};
    float8 enter = (float8)NEARLIGHT_SEGMENT_T_MIN;
    float8 leave = (float8)NEARLIGHT_SEGMENT_T_MAX;
    for (uint axis = 0; axis < 3; ++axis) {
        const global float* planes = node->low[axis];
        if (!shaft->straddles) {
            const uint near = shaft->near[axis];
            enter = max8(enter, (vload8(0, planes + near) - origin[axis]) * shaft->by_near[axis]);
            leave =
                min8(leave, (vload8(0, planes + (WIDE_UPPER - near)) - origin[axis]) * shaft->by_far[axis]);
            continue;
        }
        const float8 low = (vload8(0, planes) - origin[axis]) * shaft->by_high[axis];
        const float8 high = (vload8(0, planes + WIDE_UPPER) - origin[axis]) * shaft->by_low[axis];
        enter = shaft->by_high[axis] > 0.0f ? max8(enter, low) : enter;
        leave = shaft->by_high[axis] > 0.0f ? leave : min8(leave, low);
        enter = shaft->by_low[axis] < 0.0f ? max8(enter, high) : enter;
        leave = shaft->by_low[axis] < 0.0f ? leave : min8(leave, high);
    }
    return enter <= leave;
}

#endif
