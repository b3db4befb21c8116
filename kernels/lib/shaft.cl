// SPDX-License-Identifier: Apache-2.0
// Shafts from a VPL to boxes around receivers. A shaft contains all segments to the receivers in its box. The
// shaft of the whole beam is tested with the eight children of a node at once, and one child with the shafts
// of all clusters at once.
#ifndef NEARLIGHT_LIB_SHAFT
#define NEARLIGHT_LIB_SHAFT

#include "lib/beam_receivers.cl"
#include "lib/ray.cl"
#include "lib/wide_tree.cl"

/// The relative margin by which bounds lie outside of what they bound. It covers several roundings.
#define SHAFT_SLACK 4e-7f

/// The volume that contains all segments of a beam: at the fraction t of its length, each segment lies within
/// t·[low, high], relative to the origin.
typedef struct Shaft {
    float3 center, extent;        // of [low, high]; the extent is half its size, with slack
    float3 reach;                 // the greater of |low| and |high|
    float by_low[3], by_high[3];  // reciprocals of low and high
    uint straddles;               // 1: low and high differ in sign along some axis
    uint near[3];                 // nearer plane of a box: 0 for the lower, WIDE_UPPER for the upper
    float by_near[3], by_far[3];  // unless it straddles: t = plane · factor, for near and far planes
} Shaft;

/// The shafts of all clusters, one in each lane. Where the beam straddles, the lower plane counts as the near
/// one.
typedef struct ClusterShafts {
    float16 by_near[3], by_far[3];
    // Where the beam straddles: FLT_MAX if the cluster straddles along that axis, else −FLT_MAX.
    float16 endless[3];
} ClusterShafts;

/// The planes of a node's eight children, the near one of each axis first, relative to the origin of the
/// segments.
typedef struct ChildPlanes {
    float8 at[6];
} ChildPlanes;

/// The planes of a box, the near one of each axis first, relative to the origin of the segments.
typedef struct Planes {
    float x0, x1, y0, y1, z0, z1;
} Planes;

/// Makes the shaft that contains all segments from `origin` to points within the bounds.
static inline void make_shaft(Shaft* shaft, float3 origin, const BeamBounds* bounds) {
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
        shaft->by_far[axis] = down ? by_high[axis] : by_low[axis];
    }
    if (shaft->straddles) {
        shaft->near[0] = shaft->near[1] = shaft->near[2] = 0;
    }
}

static inline void make_cluster_shafts(ClusterShafts* clusters, const Shaft* shaft, float3 from,
                                       const BeamBounds* bounds) {
    const float origin[3] = {from.x, from.y, from.z};
    for (uint axis = 0; axis < 3; ++axis) {
        const float16 by_low = reciprocal16(bounds->cluster_low[axis] - origin[axis]);
        const float16 by_high = reciprocal16(bounds->cluster_high[axis] - origin[axis]);
        const bool down = shaft->near[axis] != 0;
        clusters->by_near[axis] = down ? by_low : by_high;
        clusters->by_far[axis] = down ? by_high : by_low;
        const int16 straddles = (by_low < 0.0f) & (by_high > 0.0f);
        clusters->endless[axis] = straddles ? (float16)FLT_MAX : (float16)-FLT_MAX;
    }
}

/// −1 in the lanes of children that the shaft may meet: those for which there is a t such that, on each axis,
/// t·high is above the lower plane and t·low below the upper one. Every segment misses a child that this
/// rejects. `relative` gets the planes of the children.
LANES_INLINE int8 children_in_shaft(const Shaft* shaft, float3 from, const global WideNode* node,
                                    ChildPlanes* relative) {
    const float origin[3] = {from.x, from.y, from.z};
    float8 enter = (float8)NEARLIGHT_SEGMENT_T_MIN;
    float8 leave = (float8)NEARLIGHT_SEGMENT_T_MAX;
#pragma unroll
    for (uint axis = 0; axis < 3; ++axis) {
        const global float* planes = node->low[axis];
        if (!shaft->straddles) {
            const uint near = shaft->near[axis];
            const float8 first = vload8(0, planes + near) - origin[axis];
            const float8 last = vload8(0, planes + (WIDE_UPPER - near)) - origin[axis];
            relative->at[2 * axis] = first;
            relative->at[2 * axis + 1] = last;
            enter = max8(enter, first * shaft->by_near[axis]);
            leave = min8(leave, last * shaft->by_far[axis]);
            continue;
        }
        const float8 first = vload8(0, planes) - origin[axis];
        const float8 last = vload8(0, planes + WIDE_UPPER) - origin[axis];
        relative->at[2 * axis] = first;
        relative->at[2 * axis + 1] = last;
        const float8 low = first * shaft->by_high[axis];
        const float8 high = last * shaft->by_low[axis];
        enter = shaft->by_high[axis] > 0.0f ? max8(enter, low) : enter;
        leave = shaft->by_high[axis] > 0.0f ? leave : min8(leave, low);
        enter = shaft->by_low[axis] < 0.0f ? max8(enter, high) : enter;
        leave = shaft->by_low[axis] < 0.0f ? leave : min8(leave, high);
    }
    // Drivers may round the reciprocals of the shaft and of its clusters differently.
    return enter <= leave * (1.0f + SHAFT_SLACK);
}

/// −1 in the lanes of children that the shaft of one cluster may meet. Every segment of the cluster misses a
/// child that this rejects. `relative` gets the planes of the children.
LANES_INLINE int8 children_in_cluster(const ClusterShafts* clusters, const Shaft* shaft, uint cluster,
                                      float3 from, const global WideNode* node, ChildPlanes* relative) {
    const float origin[3] = {from.x, from.y, from.z};
    float8 enter = (float8)NEARLIGHT_SEGMENT_T_MIN;
    float8 leave = (float8)NEARLIGHT_SEGMENT_T_MAX;
#pragma unroll
    for (uint axis = 0; axis < 3; ++axis) {
        const global float* planes = node->low[axis];
        const uint near = shaft->near[axis];
        const float by_near = ((const float*)&clusters->by_near[axis])[cluster];
        const float by_far = ((const float*)&clusters->by_far[axis])[cluster];
        const float8 first = vload8(0, planes + near) - origin[axis];
        const float8 last = vload8(0, planes + (WIDE_UPPER - near)) - origin[axis];
        relative->at[2 * axis] = first;
        relative->at[2 * axis + 1] = last;
        const float8 t0 = first * by_near;
        const float8 t1 = last * by_far;
        if (!shaft->straddles) {
            enter = max8(enter, t0);
            leave = min8(leave, t1);
            continue;
        }
        const float endless = ((const float*)&clusters->endless[axis])[cluster];
        const float8 low = min8(t0, t1), high = max8(t0, t1);
        enter = max8(enter, max8(low, min8(high, (float8)endless)));
        leave = min8(leave, max8(high, (float8)endless));
    }
    // The minima and maxima turn the planes of a missing child into a box.
    return (enter <= leave * (1.0f + SHAFT_SLACK)) & (vload8(0, node->low[0]) < INFINITY);
}

/// The planes of child `slot`.
LANES_INLINE Planes planes_of(const ChildPlanes* relative, uint slot) {
    const float* at = (const float*)relative + slot;
    const Planes planes = {at[0], at[8], at[16], at[24], at[32], at[40]};
    return planes;
}

/// One bit for each cluster whose shaft may meet the box.
LANES_INLINE uint clusters_in_box(const ClusterShafts* c, bool straddles, const Planes* p) {
    const float16 x0 = p->x0 * c->by_near[0], x1 = p->x1 * c->by_far[0];
    const float16 y0 = p->y0 * c->by_near[1], y1 = p->y1 * c->by_far[1];
    const float16 z0 = p->z0 * c->by_near[2], z1 = p->z1 * c->by_far[2];
    const float16 t_min = (float16)NEARLIGHT_SEGMENT_T_MIN, t_max = (float16)NEARLIGHT_SEGMENT_T_MAX;
    const float slack = 1.0f + SHAFT_SLACK;
    if (!straddles) {
        const float16 enter = max16(max16(x0, y0), max16(z0, t_min));
        return lane_bits16(enter <= slack * min16(min16(x1, y1), min16(z1, t_max)));
    }
    // Along an axis where a cluster straddles, both planes bound t from below only.
    const float16 low_x = min16(x0, x1), low_y = min16(y0, y1), low_z = min16(z0, z1);
    const float16 high_x = max16(x0, x1), high_y = max16(y0, y1), high_z = max16(z0, z1);
    const float16 enter = max16(max16(max16(low_x, min16(high_x, c->endless[0])),  //
                                      max16(low_y, min16(high_y, c->endless[1]))),
                                max16(max16(low_z, min16(high_z, c->endless[2])), t_min));
    const float16 leave = min16(min16(max16(high_x, c->endless[0]), max16(high_y, c->endless[1])),
                                min16(max16(high_z, c->endless[2]), t_max));
    return lane_bits16(enter <= slack * leave);
}

#endif
