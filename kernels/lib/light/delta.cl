// SPDX-License-Identifier: Apache-2.0
// Delta lights, which light from a single point or direction, so that no path can hit them.
#ifndef NEARLIGHT_LIB_LIGHT_DELTA
#define NEARLIGHT_LIB_LIGHT_DELTA

#include "lib/texture.cl"

/// The colour that the light's image has at (s, t); white for a light without one.
static inline float3 image_color(const SceneView* scene, const global Emitter* emitter, float2 st) {
    if (emitter->image == 0) {
        return (float3)(1.0f);
    }
    return texture_color(scene, emitter->image - 1, (float2)(st.x, 1.0f - st.y));
}

/// What remains of a spot's intensity in this direction. The chord to the axis tells small angles apart,
/// which the cosine does not.
static inline float spot_falloff(const global Emitter* emitter, float3 direction) {
    const float angle = 2.0f * asin(fmin(0.5f * length(direction - load3(emitter->direction)), 1.0f));
    if (angle <= emitter->beam_angle) {
        return 1.0f;
    }
    const float width = emitter->cutoff_angle - emitter->beam_angle;
    return angle >= emitter->cutoff_angle ? 0.0f : (emitter->cutoff_angle - angle) / width;
}

/// Intensity of a point light, spot or projector towards `direction` (unit, away from the light), W/sr.
static inline float3 delta_intensity(const SceneView* scene, const global Emitter* emitter,
                                     float3 direction) {
    const float3 intensity = load3(emitter->radiance);
    if (emitter->type == NEARLIGHT_EMITTER_POINT) {
        return intensity;
    }
    const float cosine = dot(direction, load3(emitter->direction));
    const float2 st =
        0.5f +
        (float2)(dot(direction, load3(emitter->x_axis)), dot(direction, load3(emitter->y_axis))) / cosine;
    if (emitter->type == NEARLIGHT_EMITTER_SPOT) {
        const float falloff = spot_falloff(emitter, direction);
        return falloff > 0.0f ? intensity * image_color(scene, emitter, st) * falloff : (float3)(0.0f);
    }
    const bool is_inside = cosine > 0.0f && st.x >= 0.0f && st.x <= 1.0f && st.y >= 0.0f && st.y <= 1.0f;
    return is_inside ? intensity * image_color(scene, emitter, st) / (cosine * cosine * cosine)
                     : (float3)(0.0f);
}

#endif
