// SPDX-License-Identifier: Apache-2.0
// What the choice of a light knows of the place that asks for it.
#ifndef NEARLIGHT_LIB_LIGHT_RECEIVER
#define NEARLIGHT_LIB_LIGHT_RECEIVER

#include "lib/scene.cl"

/// A place that asks lights. Part of the choice follows the lobe of a glossy surface.
typedef struct LightReceiver {
    float3 x;
    float3 n;       // zero: light counts from all sides
    float3 viewer;  // unit vector to the viewer
    float gloss;    // the part of the choice that follows the lobe, from 0 (no viewer) to less than 1
    float alpha;    // roughness of the lobe
} LightReceiver;

/// A place whose lights are chosen by the irradiance that they may bring.
static inline LightReceiver even_receiver(float3 x, float3 n) {
    LightReceiver at;
    at.x = x;
    at.n = n;
    at.viewer = n;
    at.gloss = at.alpha = 0.0f;
    return at;
}

/// A place of which `share` (from 0 to 1) of the light comes by a lobe of the roughness `alpha` (0: there is
/// none). A tenth of the choice follows irradiance all the same, since a surface may reflect in other ways
/// besides.
static inline LightReceiver glossy_receiver(float3 x, float3 n, float3 viewer, float share, float alpha) {
    LightReceiver at = even_receiver(x, n);
    at.viewer = viewer;
    at.gloss = alpha > 0.0f ? 0.9f * share : 0.0f;
    at.alpha = alpha;
    return at;
}

#endif
