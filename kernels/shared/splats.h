// SPDX-License-Identifier: Apache-2.0
// Splats: what the samples of a pixel bring to it and to the pixels around it (splats.cl).
#ifndef NEARLIGHT_SHARED_SPLATS_H
#define NEARLIGHT_SHARED_SPLATS_H

#include "shared/types.h"

#ifdef __cplusplus
namespace nearlight::core {
#endif

/// Sums over samples of one pixel, each weighted by the reconstruction filter of a pixel that they reach:
/// radiance and the weights themselves. The halves are those of the samples by their numbers.
typedef struct Splat {
    Vec3 direct;
    float weight;
    Vec3 indirect;
    float half_weight;  // of the first half
    Vec3 half_light;    // direct and indirect of the first half
    float coverage;     // of samples that met a surface
} Splat;

/// The same sums for the light that camera paths bring on their own, where some pixels get more such paths
/// than others (camera_lights.cl).
typedef struct CameraSplat {
    Vec3 first;  // half of the samples
    float first_weight;
    Vec3 second;
    float second_weight;
} CameraSplat;

/// What all pixels of one row bring to a pixel.
typedef struct RowSplat {
    Splat all;
    CameraSplat camera;  // zero where `all` holds this light, too
} RowSplat;

/// A pixel brings light to pixels that are at most this many columns and rows away.
#define NEARLIGHT_MAX_SPLAT_REACH 2u

/// The number of rows that have splats for a pixel.
NEARLIGHT_SHARED_FUNCTION uint splat_rows(uint reach) {
    return 2 * reach + 1;
}

#ifdef __cplusplus
NEARLIGHT_CHECK_SHARED(Splat, 48);
NEARLIGHT_CHECK_SHARED(CameraSplat, 32);
NEARLIGHT_CHECK_SHARED(RowSplat, 80);
}  // namespace nearlight::core
#endif

#endif
