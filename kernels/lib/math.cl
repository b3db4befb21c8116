// SPDX-License-Identifier: Apache-2.0
// Small vector helpers.
#ifndef NEARLIGHT_LIB_MATH
#define NEARLIGHT_LIB_MATH

#include "shared/types.h"

// A macro, because NVIDIA's compiler reads the parts of a struct that is passed by value byte by byte.
#define load3(v) ((float3)((v).x, (v).y, (v).z))
static inline Vec3 store3(float3 v) {
    Vec3 result;
    result.x = v.x;
    result.y = v.y;
    result.z = v.z;
    return result;
}
static inline float max_component(float3 v) {
    return fmax(v.x, fmax(v.y, v.z));
}
static inline float luminance(float3 c) {
    return dot(c, (float3)(0.2126f, 0.7152f, 0.0722f));
}
static inline bool is_black(float3 c) {
    return !(max_component(c) > 0.0f);
}

/// How far a point must stand off a surface of which nothing else is known, in metres, so that rays from it
/// do not meet that surface again. host/scene/ray_epsilon.h has the same formula.
static inline float ray_epsilon(float3 p, float extent) {
    return 2e-5f * fmax(max_component(fabs(p)), 0.05f * extent);
}

/// A right-handed orthonormal frame about the unit vector n.
/// [Duff et al., Building an Orthonormal Basis, Revisited, JCGT 2017]
typedef struct Frame {
    float3 tangent, bitangent, n;
} Frame;
static inline Frame make_frame(float3 n) {
    const float s = n.z < 0.0f ? -1.0f : 1.0f;
    const float a = -1.0f / (s + n.z);
    const float b = n.x * n.y * a;
    Frame frame;
    frame.tangent = (float3)(1.0f + s * n.x * n.x * a, s * b, -s * n.x);
    frame.bitangent = (float3)(b, s + n.y * n.y * a, -n.y);
    frame.n = n;
    return frame;
}
static inline float3 frame_to_world(const Frame* frame, float3 v) {
    return v.x * frame->tangent + v.y * frame->bitangent + v.z * frame->n;
}
static inline float3 world_to_frame(const Frame* frame, float3 v) {
    return (float3)(dot(v, frame->tangent), dot(v, frame->bitangent), dot(v, frame->n));
}
/// Converts a vector from the frame about n to world space.
static inline float3 to_world_frame(float3 v, float3 n) {
    const Frame frame = make_frame(n);
    return frame_to_world(&frame, v);
}

/// A unit vector in two numbers of 16 bits, by the octahedral map [Cigolle et al., A Survey of Efficient
/// Representations for Independent Unit Vectors, JCGT 2014]. Its error is below 1e-4.
static inline uint pack_direction(float3 d) {
    const float2 plane = d.xy / fmax(fabs(d.x) + fabs(d.y) + fabs(d.z), 1e-20f);
    const float2 sign = (float2)(plane.x < 0.0f ? -1.0f : 1.0f, plane.y < 0.0f ? -1.0f : 1.0f);
    const float2 folded = d.z < 0.0f ? (1.0f - fabs(plane.yx)) * sign : plane;
    const float2 scaled = round(clamp(folded * 0.5f + 0.5f, 0.0f, 1.0f) * 65535.0f);
    return (uint)scaled.x | (uint)scaled.y << 16;
}
static inline float3 unpack_direction(uint packed) {
    const float2 folded =
        (float2)((float)(packed & 0xffffu), (float)(packed >> 16)) * (2.0f / 65535.0f) - 1.0f;
    const float z = 1.0f - fabs(folded.x) - fabs(folded.y);
    const float2 sign = (float2)(folded.x < 0.0f ? -1.0f : 1.0f, folded.y < 0.0f ? -1.0f : 1.0f);
    const float2 plane = z < 0.0f ? (1.0f - fabs(folded.yx)) * sign : folded;
    return normalize((float3)(plane.x, plane.y, z));
}

#endif
