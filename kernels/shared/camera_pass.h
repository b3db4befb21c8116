// SPDX-License-Identifier: Apache-2.0
// One launch of camera_pass.cl.
#ifndef NEARLIGHT_SHARED_CAMERA_PASS_H
#define NEARLIGHT_SHARED_CAMERA_PASS_H

#include "shared/packet_order.h"

#ifdef __cplusplus
namespace nearlight::core {
#endif

/// How camera paths are followed.
typedef struct CameraLimits {
    uint max_edges;      // from the camera to a light; 1 sees lights themselves only
    uint light_samples;  // at each surface that reflects other than by a Lambertian part
    uint light_rays;     // of those that the camera sees, or sees in mirrors and through glass
    float min_weight;    // the light of receivers that weigh less than this is traced at once
    uint bundle_rays;    // of a bundle, which look for the sky for the first surfaces too
} CameraLimits;

/// The part of the picture that a launch covers, and how.
typedef struct CameraPassParams {
    PacketOrder order;  // of the receivers
    uint first_tile_column, first_tile_row;
    uint tile_row_count;   // of whole bundles
    uint first_sample;     // of each pixel
    uint sequence_length;  // samples of a pixel over all launches
    uint seed;
    CameraLimits limits;
    uint pad0, pad1;
} CameraPassParams;

#ifdef __cplusplus
NEARLIGHT_CHECK_SHARED(CameraPassParams, 80);
}  // namespace nearlight::core
#endif

#endif
