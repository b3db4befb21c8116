// SPDX-License-Identifier: Apache-2.0
// Open cylinders that shine, each of them one light. A direction to one has an angle φ across the axis, which
// is uniform over the angle that the cylinder covers there, and an elevation α along it, uniform between
// those of the two ends: nearly uniform over the solid angle, which is cosα dα dφ.
//
// Rays meet the prism that stands for a cylinder and has its area.
#ifndef NEARLIGHT_LIB_LIGHT_CYLINDER
#define NEARLIGHT_LIB_LIGHT_CYLINDER

#include "lib/light/sphere.cl"

/// A cylinder seen from a point.
typedef struct SeenCylinder {
    float3 across;     // unit, from the point to the axis at a right angle
    float3 beside;     // unit, at right angles to that and to the axis
    float3 axis;       // unit
    float distance;    // to the axis
    float low, high;   // the ends, measured along the axis from the point
    float radius;      // m
    float half_angle;  // greatest φ; 0 where the point does not lie outside
} SeenCylinder;

static inline SeenCylinder seen_cylinder(const global Emitter* emitter, float3 x) {
    SeenCylinder seen;
    const float3 to_end = load3(emitter->position) - x;
    seen.axis = load3(emitter->direction);
    seen.low = dot(to_end, seen.axis);
    seen.high = seen.low + emitter->length;
    const float3 to_axis = to_end - seen.low * seen.axis;
    seen.distance = length(to_axis);
    seen.radius = emitter->radius;
    const bool is_outside = seen.distance > emitter->outer_radius;
    seen.across = is_outside ? to_axis / seen.distance : make_frame(seen.axis).tangent;
    seen.beside = cross(seen.axis, seen.across);
    seen.half_angle = is_outside ? asin(fmin(seen.radius / seen.distance, 1.0f)) : 0.0f;
    return seen;
}

/// The distance from the point to a coaxial cylinder of the given radius, across the axis at the angle φ.
static inline float distance_across(const SeenCylinder* seen, float sine, float cosine, float radius) {
    const float past = seen->distance * sine;
    return seen->distance * cosine - sqrt(fmax(0.0f, radius * radius - past * past));
}

/// The difference between the elevations of the two ends, at this distance across the axis.
static inline float elevation_range(const SeenCylinder* seen, float across) {
    return atan2(across * (seen->high - seen->low), across * across + seen->low * seen->high);
}

/// The density of sample_cylinder() in a unit direction.
static inline float cylinder_pdf(const global Emitter* emitter, float3 x, float3 direction) {
    const SeenCylinder seen = seen_cylinder(emitter, x);
    const float2 flat = (float2)(dot(direction, seen.across), dot(direction, seen.beside));
    const float cos_elevation = length(flat);
    if (!(seen.half_angle > 0.0f) || !(flat.x > 0.0f) ||
        !(fabs(flat.y) * seen.distance < seen.radius * cos_elevation)) {
        return 0.0f;
    }
    const float across = distance_across(&seen, flat.y / cos_elevation, flat.x / cos_elevation, seen.radius);
    const float along = across * dot(direction, seen.axis) / cos_elevation;
    const bool meets = along > seen.low && along < seen.high;
    return meets ? 1.0f / (2.0f * seen.half_angle * elevation_range(&seen, across) * cos_elevation) : 0.0f;
}

static inline RoundSample sample_cylinder(const global Emitter* emitter, float3 x, float2 u) {
    const SeenCylinder seen = seen_cylinder(emitter, x);
    const float phi = (2.0f * u.x - 1.0f) * seen.half_angle;
    const float sine = sin(phi);
    const float cosine = cos(phi);
    const float across = distance_across(&seen, sine, cosine, seen.radius);
    const float range = elevation_range(&seen, across);
    const float elevation = atan2(seen.low, across) + u.y * range;
    const float cos_elevation = cos(elevation);
    RoundSample sample;
    sample.pdf = seen.half_angle > 0.0f && cos_elevation > 0.0f
                     ? 1.0f / (2.0f * seen.half_angle * range * cos_elevation)
                     : 0.0f;
    const float3 flat = cosine * seen.across + sine * seen.beside;
    sample.direction = cos_elevation * flat + sin(elevation) * seen.axis;
    const float outer = distance_across(&seen, sine, cosine, emitter->outer_radius);
    sample.point = x + outer / fmax(cos_elevation, 1e-6f) * sample.direction;
    sample.normal = (outer * flat - seen.distance * seen.across) / emitter->outer_radius;
    return sample;
}

#endif
