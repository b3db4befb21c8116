// SPDX-License-Identifier: Apache-2.0
// Where walks aim (WalkAim): how they are divided between its sphere, its openings and all other ways.
//
// Walks aim in the same way where they enter the scene or leave a lamp (lib/light/emission.cl) and where they
// go on from a surface (lib/aim_cone.cl). Of those that aim at a target, half go towards it, evenly over what
// it covers. The other half pass around it, because it may not hold all of the window through which its light
// comes: each doubling of the circle around it gets as many. The density of a walk is always that of all ways
// together, so that none counts for much only because it came by an unlikely one.
#ifndef NEARLIGHT_LIB_WALK_AIM
#define NEARLIGHT_LIB_WALK_AIM

#include "lib/math.cl"
#include "shared/walk_aim.h"

#define MAX_AIM_TARGETS (1 + NEARLIGHT_MAX_OPENINGS)
#define NO_AIM_TARGET ~0u

/// The parts of the walks that aim at the sphere where there are no openings to aim at, and where there are.
#define PART_SPHERE_ALONE (2.0f / 3.0f)
#define PART_SPHERE 0.25f
#define PART_OPENINGS 0.5f
/// The part of those that aim at a sphere which goes towards it; the others pass around it.
#define PART_TOWARDS 0.5f

/// Whether a walk that aims at a target goes towards it. Turns its number in [0, 1) into one that is uniform
/// in [0, 1) for walks of the same answer.
static inline bool goes_towards(float* u) {
    const bool towards = *u < PART_TOWARDS;
    *u = towards ? *u / PART_TOWARDS : (*u - PART_TOWARDS) / (1.0f - PART_TOWARDS);
    return towards;
}

/// A sphere at which walks may aim: number 0 is the sphere that holds what the camera sees, and the openings
/// follow.
typedef struct AimTarget {
    float3 center;
    float radius;     // m
    float3 outwards;  // unit vector of an opening; zero for number 0
} AimTarget;

static inline uint aim_target_count(const WalkAim* aim) {
    return 1 + aim->opening_count;
}

static inline AimTarget aim_target(const WalkAim* aim, uint number) {
    AimTarget target;
    if (number == 0) {
        target.center = load3(aim->center);
        target.radius = aim->radius;
        target.outwards = (float3)(0.0f);
    } else {
        const Opening* opening = aim->openings + (number - 1);
        target.center = load3(opening->center);
        target.radius = opening->radius;
        target.outwards = load3(opening->outwards);
    }
    return target;
}

/// The cover of a ring around a target, for u in [0, 1): between `min_cover`, that of the target itself, and
/// `max_cover`, each doubling is equally likely. Cover is the squared radius on a disc, and 1 − cosine of the
/// half angle in a cone.
static inline float cover_around(float min_cover, float max_cover, float u) {
    return min_cover * pow(max_cover / min_cover, u);
}

/// The density of these covers.
static inline float density_around(float min_cover, float max_cover, float cover) {
    return 1.0f / (cover * log(max_cover / min_cover));
}

/// The part of the walks that aims at each target, and all of them together.
typedef struct AimParts {
    float of[MAX_AIM_TARGETS];
    float sum;
} AimParts;

/// Divides walks between the targets that are of use to them: those whose bits are set.
static inline AimParts divide_aim(const WalkAim* aim, uint useful) {
    AimParts parts;
    float shares = 0.0f;
    for (uint i = 0; i < aim->opening_count; ++i) {
        shares += (useful >> (1 + i) & 1) != 0 ? aim->openings[i].share : 0.0f;
    }
    const float of_sphere = shares > 0.0f ? PART_SPHERE : PART_SPHERE_ALONE;
    parts.of[0] = (useful & 1) != 0 ? of_sphere : 0.0f;
    parts.sum = parts.of[0];
    for (uint i = 0; i < aim->opening_count; ++i) {
        const bool is_useful = (useful >> (1 + i) & 1) != 0 && shares > 0.0f;
        parts.of[1 + i] = is_useful ? PART_OPENINGS * aim->openings[i].share / shares : 0.0f;
        parts.sum += parts.of[1 + i];
    }
    return parts;
}

/// The target that a walk's number in [0, 1) chooses, or NO_AIM_TARGET. Turns the number into one that is
/// uniform in [0, 1) for walks of the same choice.
static inline uint choose_aim_target(const AimParts* parts, uint count, float* u) {
    float before = 0.0f;
    for (uint number = 0; number < count; ++number) {
        const float part = parts->of[number];
        if (*u < before + part) {
            *u = fmin((*u - before) / part, 1.0f - 0x1p-24f);
            return number;
        }
        before += part;
    }
    *u = fmin((*u - before) / (1.0f - before), 1.0f - 0x1p-24f);
    return NO_AIM_TARGET;
}

#endif
