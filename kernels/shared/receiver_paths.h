// SPDX-License-Identifier: Apache-2.0
// One launch of receiver_paths.cl.
#ifndef NEARLIGHT_SHARED_RECEIVER_PATHS_H
#define NEARLIGHT_SHARED_RECEIVER_PATHS_H

#include "shared/types.h"

#ifdef __cplusplus
namespace nearlight::core {
#endif

/// What receivers ask of the scene, and what of it they leave to their bundles.
typedef struct ReceiverPathParams {
    uint packet_count;   // packets of receivers
    uint light_samples;  // that each receiver takes of lights
    uint rays;           // rays that each receiver sends
    uint max_edges;      // of a path from a light to a receiver with no surfaces before it
    float clamp_radius;  // m
    uint seed;
    uint shares;         // what goes to bundles: NEARLIGHT_SHARES_… of shared/shared_light.h
    uint aimed_rays;     // rays that each receiver sends besides to mirrors and glass (lib/caustic_aim.cl)
    float shared_limit;  // radiance of places, W/m²/sr, above which light met by chance stays with receivers
} ReceiverPathParams;

#ifdef __cplusplus
NEARLIGHT_CHECK_SHARED(ReceiverPathParams, 36);
}  // namespace nearlight::core
#endif

#endif
