// SPDX-License-Identifier: Apache-2.0
// Directions from a surface, a lamp's or another, to the spheres at which walks aim (lib/walk_aim.cl), and
// around them.
//
// A walk that starts or lands far from such a sphere seldom finds it by chance, and one that does stands for
// much light: the farther it comes from, the more. The VPL that it leaves would outshine all others.
#ifndef NEARLIGHT_LIB_AIM_CONE
#define NEARLIGHT_LIB_AIM_CONE

#include "lib/sampling.cl"
#include "lib/walk_aim.cl"

/// From which distance on, in radii of a sphere, a surface is far from it.
#define FAR_IN_RADII 2.0f

/// The cone in which a point sees a target.
typedef struct AimCone {
    float3 axis;
    float height;  // 1 − cosine of half the angle of the cone
} AimCone;

static inline AimCone aim_cone(const AimTarget* target, float3 x) {
    const float3 way = target->center - x;
    const float distance = length(way);
    const float sine = target->radius / distance;
    AimCone cone;
    cone.axis = way / distance;
    cone.height = cone_height(sine * sine);
    return cone;
}

/// A direction towards the target, evenly over its cone, or around it in a cone of up to a hemisphere.
static inline float3 aim_cone_sample(const AimCone* cone, bool towards, float2 u) {
    const float height = towards ? u.x * cone->height : cover_around(cone->height, 1.0f, u.x);
    return to_world_frame(cone_direction(height, u.y), cone->axis);
}

/// The density of these directions per steradian.
static inline float aim_cone_pdf(const AimCone* cone, float3 direction) {
    if (!(dot(direction, cone->axis) > 0.0f)) {
        return 0.0f;
    }
    const float3 across = cross(direction, cone->axis);
    const float height = cone_height(dot(across, across));
    const float density = height <= cone->height
                              ? PART_TOWARDS / cone->height
                              : (1.0f - PART_TOWARDS) * density_around(cone->height, 1.0f, height);
    return density / (2.0f * M_PI_F);
}

/// The targets that are of use to a walk that leaves x, on a surface with this normal: those that are far,
/// partly above its horizon, and, if they are openings, seen from outside.
static inline uint targets_for_surface(const WalkAim* aim, float3 x, float3 normal) {
    uint useful = 0;
    for (uint number = 0; number < aim_target_count(aim); ++number) {
        const AimTarget target = aim_target(aim, number);
        const float3 way = target.center - x;
        const float far = FAR_IN_RADII * target.radius;
        const bool is_outside = number == 0 || -dot(way, target.outwards) > target.radius;
        if (target.radius > 0.0f && dot(way, way) > far * far && dot(way, normal) > -target.radius &&
            is_outside) {
            useful |= 1u << number;
        }
    }
    return useful;
}

/// The density per steradian with which walks at x choose a direction by aim.
static inline float aim_pdf(const WalkAim* aim, const AimParts* parts, float3 x, float3 direction) {
    float pdf = 0.0f;
    for (uint number = 0; number < aim_target_count(aim); ++number) {
        if (parts->of[number] > 0.0f) {
            const AimTarget target = aim_target(aim, number);
            const AimCone cone = aim_cone(&target, x);
            pdf += parts->of[number] * aim_cone_pdf(&cone, direction);
        }
    }
    return pdf;
}

#endif
