// SPDX-License-Identifier: Apache-2.0
// Directions from a surface to the sphere at which walks aim, and around it.
//
// A walk that lands far from this sphere seldom finds it by chance, and one that does stands for much light:
// the farther it comes from, the more. Such a VPL would outshine all others. So walks that land far away do
// as those that enter the scene (lib/light/emission.cl): a third goes on towards the sphere, evenly over the
// cone that it fills; a third goes around it, where there may be a window through which its light comes, and
// each doubling of the cone gets as many; a third follows the BSDF.
#ifndef NEARLIGHT_LIB_AIM_CONE
#define NEARLIGHT_LIB_AIM_CONE

#include "lib/light/emission.cl"
#include "lib/sampling.cl"

/// From which distance on, in radii of the sphere, a surface is far.
#define FAR_IN_RADII 2.0f

typedef struct AimCone {
    float3 axis;
    float height;  // 1 − cosine of half the angle of the cone
    uint is_used;  // 0: the sphere is near, or behind the surface
} AimCone;

/// 1 − cosine of the angle of this sine, which is below 90°, without the loss of digits that small angles
/// would suffer.
static inline float cone_height(float squared_sine) {
    return squared_sine / (1.0f + sqrt(fmax(1.0f - squared_sine, 0.0f)));
}

static inline AimCone aim_cone(WalkAim aim, float3 x, float3 normal) {
    const float3 way = load3(aim.center) - x;
    const float distance = length(way);
    const float sine = aim.radius / distance;
    AimCone cone;
    cone.is_used =
        aim.radius > 0.0f && distance > FAR_IN_RADII * aim.radius && dot(way, normal) > -aim.radius;
    cone.axis = cone.is_used ? way / distance : normal;
    cone.height = cone.is_used ? cone_height(sine * sine) : 1.0f;
    return cone;
}

/// The direction that the numbers choose, where u < PART_AIMED + PART_AROUND.
static inline float3 aim_cone_sample(const AimCone* cone, float u, float2 v) {
    const float height = u < PART_AIMED ? v.x * cone->height : pow(cone->height, v.x);
    const float across = sqrt(height * (2.0f - height));
    return to_world_frame((float3)(across * circle_point(v.y), 1.0f - height), cone->axis);
}

/// The density per steradian of the directions that aim_cone_sample() takes, of which there are PART_AIMED
/// + PART_AROUND.
static inline float aim_cone_pdf(const AimCone* cone, float3 direction) {
    if (!(dot(direction, cone->axis) > 0.0f)) {
        return 0.0f;
    }
    const float3 across = cross(direction, cone->axis);
    const float height = cone_height(dot(across, across));
    const float part =
        height <= cone->height ? PART_AIMED / cone->height : PART_AROUND / (height * -log(cone->height));
    return part / (2.0f * M_PI_F);
}

#endif
