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
    uint light_rays;     // from such surfaces that the camera sees straight, in mirrors or through glass
    // Light of receivers that weigh less, or that have few edges left behind mirrors or glass, is traced at
    // once; 0: none is.
    float min_weight;
    uint bundle_rays;  // rays of a bundle that look for the sky for the first surfaces, too; 0: none do
} CameraLimits;

/// The pixels that a launch looks at instead of those at its places. Its places, row by row, take one pixel
/// of a list after the other.
typedef struct PixelList {
    uint count;  // of pixels; 0: there is no list
    uint first;  // place of the first one in the list
    uint width;  // of the part of the picture whose pixels the list numbers row by row
    uint x, y;   // of this part's first pixel
} PixelList;

/// The part of the picture that a launch covers, and how.
typedef struct CameraPassParams {
    PacketOrder order;  // of the receivers
    uint first_tile_column, first_tile_row;
    uint tile_row_count;  // of whole bundles
    uint first_sample;    // of each pixel
    uint in_middle;       // 1: samples go through the middle of their pixel
    uint seed;
    CameraLimits limits;
    PixelList list;
    uint pad0;
} CameraPassParams;

/// The light that the camera paths of a pixel bring on their own: sums of CameraVertex.camera_light times the
/// filter's weights over the first half of the pixel's samples, and over the second half.
typedef struct CameraLight {
    Vec3 first;
    Vec3 second;
} CameraLight;
/// How often the camera paths of a pixel may double (camera_lights.cl).
#define NEARLIGHT_MAX_ROUNDS 3u
/// The variance of a sample's camera light ÷ squared light of its pixel at which the first samples are enough
/// (bench/log/refine.md).
#define NEARLIGHT_ENOUGH_VARIANCE 0.064f

#ifdef __cplusplus
NEARLIGHT_CHECK_SHARED(CameraPassParams, 96);
NEARLIGHT_CHECK_SHARED(CameraLight, 24);
}  // namespace nearlight::core
#endif

#endif
