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
    Vec3 position;  // off its surface by triangle_stand_off()
    float weight;   // in proportion to which bundles draw; 0: no light
    Vec3 normal;    // of the triangle, on the side of the finder
    ushort curve;   // row of the surface's transmission curve
    ushort veils;   // number of veils between a light behind veils and its finder
    Vec3 radiance;  // W/m²/sr, which it sends to all sides times the curve; for lights of the sky, a factor
                    // of the sky's radiance
    uint shading;   // shading normal, as pack_direction() packs it
} SharedLight;
#define NEARLIGHT_SHARED_LIGHTS 64u         // about how many near lights a bundle uses
#define NEARLIGHT_SHARED_SKY_LIGHTS 32u     // about how many lights of the sky a bundle uses
#define NEARLIGHT_SHARED_VEILED_LIGHTS 32u  // about how many lights behind veils a bundle uses
/// The room for a bundle's list of lights. Rounding may add one to those that it uses.
#define NEARLIGHT_SHARED_LIST (NEARLIGHT_SHARED_LIGHTS + 1u)

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

/// One launch of shared_sky.cl.
typedef struct SharedSkyParams {
    uint packet_count;   // packets of receivers
    uint rays;           // that each receiver sends
    uint light_samples;  // that each receiver takes of lights
    uint max_edges;      // of a path from a light to a receiver with no surfaces before it
    uint has_seen;       // 1: the surfaces that the camera sees ask too
    uint seen_rays;      // that each of these sends in search of lights
    uint pad0, pad1;
} SharedSkyParams;

/// A surface that reflects light other than diffusely to the receivers of a bundle (shared_reflections.cl).
/// The SharedLight that belongs to it has its place, and the radiance that arrives there.
typedef struct SharedReflection {
    uint triangle;
    float u, v;       // weights of the triangle's v1 and v2
    float model;      // random number that chooses between the parts of masks and blends
    Vec3 arriving;    // unit vector to where the light comes from
    float light_pdf;  // with which light samples of the surface pick this direction, per steradian, or minus
                      // the probability of the delta light, which no ray meets
} SharedReflection;
#define NEARLIGHT_SHARED_REFLECTIONS 16u  // about how many reflections a bundle uses
/// A lobe must be this many times as wide as the neighbourhood of a receiver looks from the surface. Where it
/// is narrower, hardly any other receiver has a use for what this one finds, and bundles show as tiles.
#define NEARLIGHT_GLOSS_REACH 0.3f

// What receivers share with their bundles, as bits.
#define NEARLIGHT_SHARES_NEAR 1u         // Lambertian light of places within the clamp radius
#define NEARLIGHT_SHARES_SKY 2u          // the sky that rays meet
#define NEARLIGHT_SHARES_REFLECTIONS 4u  // light that rough gloss reflects
#define NEARLIGHT_SHARES_VEILED 8u       // Lambertian light of places behind veils

#ifdef __cplusplus
NEARLIGHT_CHECK_SHARED(SeenSurface, 32);
NEARLIGHT_CHECK_SHARED(SharedSkyParams, 32);
NEARLIGHT_CHECK_SHARED(SharedReflection, 32);
NEARLIGHT_CHECK_SHARED(SharedLight, 48);
static_assert(offsetof(SharedLight, normal) == offsetof(Vpl, normal),
              "a beam connects to a SharedLight as to a Vpl");
}  // namespace nearlight::core
#endif

#endif
