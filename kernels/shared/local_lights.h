// SPDX-License-Identifier: Apache-2.0
// The radius that VPLs are gathered with beside local lights (lib/path_walk.cl), and one launch of
// local_light_rays (local_lights.cl).
#ifndef NEARLIGHT_SHARED_LOCAL_LIGHTS_H
#define NEARLIGHT_SHARED_LOCAL_LIGHTS_H

#include "shared/types.h"

#ifdef __cplusplus
namespace nearlight::core {
#endif

/// The law of the radius at which the geometry term is bounded for light from a place y: max_radius /
/// 2^level, but not below min_radius. The level is the first (of GATHER_LEVELS) for which the radius is at
/// most at_unit_light / √E, where E is the luminance of the direct light at y (W/m²), so that the radius
/// follows the distance between VPLs of walks. E is a rough estimate whose random numbers are hashes of y.
/// The radius is thus a function of the place alone and does not depend on the VPLs there.
typedef struct GatherRadius {
    float max_radius;     // m
    float min_radius;     // m
    float at_unit_light;  // m·√(W/m²); infinite: the level is 0 everywhere
    uint seed;
} GatherRadius;

/// Which receivers send rays, and what the lights are made of that these find.
typedef struct LocalLightParams {
    GatherRadius law;   // its seed is that of all random numbers
    uint first_packet;  // of the receivers
    uint slot_count;    // rays of this launch
    uint rays_per_receiver;
    uint vpl_count;
    uint connections;     // from each light to VPLs
    uint bounce_count;    // max edges of a path from an emitter to a light
    uint direct_samples;  // that each light takes of lamps and the environment
    uint pad0;
} LocalLightParams;

#ifdef __cplusplus
NEARLIGHT_CHECK_SHARED(GatherRadius, 16);
NEARLIGHT_CHECK_SHARED(LocalLightParams, 48);
}  // namespace nearlight::core
#endif

#endif
