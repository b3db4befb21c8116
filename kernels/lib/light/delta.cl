// SPDX-License-Identifier: Apache-2.0
// Delta lights, which light from a single point or direction, so that no path can hit them.
#ifndef NEARLIGHT_LIB_LIGHT_DELTA
#define NEARLIGHT_LIB_LIGHT_DELTA

#include "lib/math.cl"

/// Intensity of a point or spot light towards `direction` (unit, away from the light), W/sr.
inline float3 delta_intensity(const global Emitter* emitter, float3 direction) {
    const float3 intensity = load3(emitter->radiance);
    if (emitter->type == NEARLIGHT_EMITTER_POINT) {
        return intensity;
    }
    const float angle = acos(clamp(dot(direction, load3(emitter->direction)), -1.0f, 1.0f));
    if (angle <= emitter->beam_angle) {
        return intensity;
    }
    const float width = emitter->cutoff_angle - emitter->beam_angle;
    return angle >= emitter->cutoff_angle ? (float3)(0.0f)
                                          : intensity * ((emitter->cutoff_angle - angle) / width);
}

#endif
