// SPDX-License-Identifier: Apache-2.0
// Transmission curves: which part of light passes through what lies over the Lambertian part of a surface, by
// the cosine of its direction. host/scene/transmission_curve.h makes them.
#ifndef NEARLIGHT_LIB_CURVE
#define NEARLIGHT_LIB_CURVE

#include "shared/material.h"

/// T(cosine) of the curve `row`; row 0 is all ones.
static inline float curve_value(const global float* curves, uint row, float cosine) {
    if (row == 0) {
        return 1.0f;
    }
    const float at = clamp(cosine, 0.0f, 1.0f) * (float)(NEARLIGHT_CURVE_SIZE - 1);
    const uint i = min((uint)at, (uint)(NEARLIGHT_CURVE_SIZE - 2));
    const global float* values = curves + row * NEARLIGHT_CURVE_SIZE + i;
    return mix(values[0], values[1], at - (float)i);
}

#endif
