// SPDX-License-Identifier: Apache-2.0
// The lights that receivers find and bundles share (kernels/shared_lights.cl).
#ifndef NEARLIGHT_SHARED_SHARED_LIGHT_H
#define NEARLIGHT_SHARED_SHARED_LIGHT_H

#include "shared/types.h"

#ifdef __cplusplus
namespace nearlight::core {
#endif

/// A light that the rays of a receiver found and that its bundle may share (shared_lights.cl). It has the
/// members of a Vpl that a connection reads in the same places.
typedef struct SharedLight {
    Vec3 position;  // stands off its surface by the ray epsilon
    float weight;   // in proportion to which bundles draw; 0: no light
    Vec3 normal;    // of the mesh
    uint curve;     // row of the surface's transmission curve
    Vec3 radiance;  // W/m²/sr, which it sends to all sides times the curve
    uint shading;   // shading normal, as pack_direction() packs it
} SharedLight;
#define NEARLIGHT_SHARED_LIGHTS 64u                           // about how many a bundle uses
#define NEARLIGHT_SHARED_SKY_LIGHTS 32u                       // the same of those of the sky
#define NEARLIGHT_SHARED_LIST (NEARLIGHT_SHARED_LIGHTS + 1u)  // rounding may add one

/// Rays of a bundle that count as one ray of a receiver where the light of the sky is divided between them
/// and others. The bundle has more, but not all of them can find what the receiver sees, and not all finds
/// are used.
#define NEARLIGHT_SKY_RAYS 16u

/// A surface that the camera sees, where it reflects other than diffusely what its bundle finds of the sky:
/// the first one of a sample, if that has a receiver.
typedef struct SeenSurface {
    uint triangle;
    float u, v;          // weights of the triangle's v1 and v2
    float model;         // random number that chooses between the parts of masks and blends
    Vec3 direction;      // unit vector from the camera
    uint light_samples;  // that the surface takes of lights; 0: it does not ask the bundle
} SeenSurface;

#ifdef __cplusplus
NEARLIGHT_CHECK_SHARED(SeenSurface, 32);
NEARLIGHT_CHECK_SHARED(SharedLight, 48);
static_assert(offsetof(SharedLight, normal) == offsetof(Vpl, normal),
              "a beam connects to a SharedLight as to a Vpl");
}  // namespace nearlight::core
#endif

#endif
