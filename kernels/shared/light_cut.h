// SPDX-License-Identifier: Apache-2.0
// The tree over a set of VPLs, through which bundles of receivers ask cuts (kernels/light_cuts.cl).
#ifndef NEARLIGHT_SHARED_LIGHT_CUT_H
#define NEARLIGHT_SHARED_LIGHT_CUT_H

#include "shared/vec3.h"

#ifdef __cplusplus
namespace nearlight::core {
#endif

#define NEARLIGHT_CUT_FANOUT 8       // max children of a node
#define NEARLIGHT_CUT_MAX_ROOTS 64u  // max nodes of the tree's top level, where a cut begins

/// Consecutive VPLs in their order along the Morton curve. Only those that have power count.
typedef struct CutNode {
    Vec3 low;
    float power;  // sum over the VPLs, each in its strongest channel, W/sr
    Vec3 high;
    float spread;   // upper bound of the distance of a VPL's normal from `axis`
    Vec3 axis;      // mean of the normals, weighted by power; shorter than 1 where they differ
    uint children;  // the number of children in the 4 lowest bits, and the index of the first one above them
} CutNode;

/// A part of a bundle's cut: a node, or a VPL where the highest bit is set.
typedef struct CutEntry {
    uint place;
    float bound;  // about what it could bring to the bundle: mean irradiance, W/m²
} CutEntry;
#define NEARLIGHT_CUT_VPL 0x80000000u

/// What bundles [first_bundle, end_bundle) ask of a tree.
typedef struct CutParams {
    uint first_root, root_count;    // the nodes of the top level
    uint leaf_count;                // nodes [0, leaf_count) have VPLs as children
    uint packet_count;              // packets of receivers
    uint first_bundle, end_bundle;  // range of bundles
    uint strata, stratum_period;    // as in lib/bundle.cl
    uint capacity;                  // max entries of a cut
    uint list_stride;               // max VPLs of a list
    float asked;                    // VPLs that a bundle asks about
    float shift;                    // uniform in [0, 1), the same for all bundles
    float clamp_radius_squared;     // m²
    uint pad0, pad1, pad2;
} CutParams;

#ifdef __cplusplus
static_assert(sizeof(CutNode) == 48 && sizeof(CutEntry) == 8 && sizeof(CutParams) == 64);
}  // namespace nearlight::core
#endif

#endif
