// SPDX-License-Identifier: Apache-2.0
// Spheres that shine, each of them one light, seen as the cone of directions that meet it.
//
// Rays meet the triangles that stand for a sphere. These have its area, so that on average over all
// directions they cover what it covers; their outlines differ from its own by a few thousandths of its
// radius.
#ifndef NEARLIGHT_LIB_LIGHT_SPHERE
#define NEARLIGHT_LIB_LIGHT_SPHERE

#include "lib/sampling.cl"
#include "lib/scene.cl"

/// A sphere seen from a point.
typedef struct SeenSphere {
    float3 to_center;
    float squared;      // of the distance to the centre
    float cone_height;  // 1 − cosine of the half angle of the cone; 0 where the point does not lie outside
} SeenSphere;

/// Between the sphere's own surface and the farthest corner of its triangles a point counts as inside: there
/// the rays that meet the triangles bring their light alone.
static inline SeenSphere seen_sphere(const global Emitter* emitter, float3 x) {
    SeenSphere seen;
    seen.to_center = load3(emitter->position) - x;
    seen.squared = dot(seen.to_center, seen.to_center);
    seen.cone_height = 0.0f;
    if (seen.squared > emitter->outer_radius * emitter->outer_radius) {
        seen.cone_height = cone_height(emitter->radius * emitter->radius / seen.squared);
    }
    return seen;
}

/// The density of a direction that is uniform over the cone, per steradian.
static inline float cone_density(const SeenSphere* seen) {
    return seen->cone_height > 0.0f ? 1.0f / (2.0f * M_PI_F * seen->cone_height) : 0.0f;
}

/// The density of sample_sphere() in a unit direction.
static inline float sphere_pdf(const global Emitter* emitter, float3 x, float3 direction) {
    const SeenSphere seen = seen_sphere(emitter, x);
    const float along = dot(seen.to_center, direction);
    const float3 past = seen.to_center - along * direction;
    const bool meets = along > 0.0f && dot(past, past) < emitter->radius * emitter->radius;
    return meets ? cone_density(&seen) : 0.0f;
}

/// A direction from x to a sphere or cylinder.
typedef struct RoundSample {
    float3 direction;  // unit
    float3 point;      // the first on the way that is as far out as the light's triangles may be
    float3 normal;     // of that point
    float pdf;         // per steradian; 0 where x does not lie outside
} RoundSample;

static inline RoundSample sample_sphere(const global Emitter* emitter, float3 x, float2 u) {
    const SeenSphere seen = seen_sphere(emitter, x);
    const float distance = sqrt(seen.squared);
    const float height = seen.cone_height * u.x;
    const float squared_sine = height * (2.0f - height);
    const float outer = emitter->outer_radius;
    RoundSample sample;
    sample.pdf = cone_density(&seen);
    sample.direction = seen.squared > 0.0f
                           ? to_world_frame(cone_direction(height, u.y), seen.to_center / distance)
                           : (float3)(0.0f, 0.0f, 1.0f);
    const float within = sqrt(fmax(0.0f, outer * outer - seen.squared * squared_sine));
    sample.point = x + (distance * (1.0f - height) - within) * sample.direction;
    sample.normal = (sample.point - load3(emitter->position)) / outer;
    return sample;
}

#endif
