// SPDX-License-Identifier: Apache-2.0
// Small vector helpers.
#ifndef NEARLIGHT_LIB_MATH
#define NEARLIGHT_LIB_MATH

#include "shared/types.h"

inline float3 load3(Vec3 v) {
    return (float3)(v.x, v.y, v.z);
}
inline Vec3 store3(float3 v) {
    Vec3 result;
    result.x = v.x;
    result.y = v.y;
    result.z = v.z;
    return result;
}
inline float max_component(float3 v) {
    return fmax(v.x, fmax(v.y, v.z));
}
inline float luminance(float3 c) {
    return dot(c, (float3)(0.2126f, 0.7152f, 0.0722f));
}
inline bool is_black(float3 c) {
    return !(max_component(c) > 0.0f);
}

/// How far a point must stand off its surface, in metres, so that rays from it do not meet that surface
/// again. host/scene/ray_epsilon.h has the same formula.
inline float ray_epsilon(float3 p, float extent) {
    return 2e-5f * fmax(max_component(fabs(p)), 0.05f * extent);
}

/// A right-handed orthonormal frame about the unit vector n.
/// [Duff et al., Building an Orthonormal Basis, Revisited, JCGT 2017]
typedef struct Frame {
    float3 tangent, bitangent, n;
} Frame;
inline Frame make_frame(float3 n) {
    const float s = n.z < 0.0f ? -1.0f : 1.0f;
    const float a = -1.0f / (s + n.z);
    const float b = n.x * n.y * a;
    Frame frame;
    frame.tangent = (float3)(1.0f + s * n.x * n.x * a, s * b, -s * n.x);
    frame.bitangent = (float3)(b, s + n.y * n.y * a, -n.y);
    frame.n = n;
    return frame;
}
inline float3 frame_to_world(const Frame* frame, float3 v) {
    return v.x * frame->tangent + v.y * frame->bitangent + v.z * frame->n;
}
inline float3 world_to_frame(const Frame* frame, float3 v) {
    return (float3)(dot(v, frame->tangent), dot(v, frame->bitangent), dot(v, frame->n));
}
/// Converts a vector from the frame about n to world space.
inline float3 to_world_frame(float3 v, float3 n) {
    const Frame frame = make_frame(n);
    return frame_to_world(&frame, v);
}

#endif
