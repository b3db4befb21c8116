// SPDX-License-Identifier: Apache-2.0
// Where walks aim (lib/walk_aim.cl).
#ifndef NEARLIGHT_SHARED_WALK_AIM_H
#define NEARLIGHT_SHARED_WALK_AIM_H

#include "shared/types.h"

#ifdef __cplusplus
namespace nearlight::core {
#endif

/// An opening, such as a window, through which light from outside comes to what the camera sees
/// (host/session/openings.h).
typedef struct Opening {
    Vec3 center;
    float radius;   // of a sphere that fills most of it, m
    Vec3 outwards;  // unit vector
    float share;    // of the walks that aim at openings; those of all openings add up to 1
} Opening;
#define NEARLIGHT_MAX_OPENINGS 8u

/// Spheres at which walks from far away aim: one that holds what the camera sees, and its openings. Without
/// them, nearly all walks from the sky would land on the grounds around a house and stay there
/// (lib/light/emission.cl for those that enter the scene, lib/aim_cone.cl for those on lamps and surfaces).
/// No walk aims at the sphere if its radius is 0, and none enters by this aim if it is about as large as the
/// scene.
typedef struct WalkAim {
    Vec3 center;
    float radius;  // m
    Opening openings[NEARLIGHT_MAX_OPENINGS];
    uint opening_count;
} WalkAim;

#ifdef __cplusplus
NEARLIGHT_CHECK_SHARED(Opening, 32);
NEARLIGHT_CHECK_SHARED(WalkAim, 276);
}  // namespace nearlight::core
#endif

#endif
