// SPDX-License-Identifier: Apache-2.0
// Rays of receivers that aim at the mirrors and the glass from which walks of light came.
//
// No light sample finds a lamp in a mirror or behind a smooth glass body, hardly one a lamp behind slightly
// rough glass, and cosine-distributed rays find them by chance: each find is a bright dot. Walks from lights
// over mirrors and glass tell where to look (caustic_aims.cl). A receiver takes those that landed near it: it
// draws one of their targets, the places where they met the last mirror or glass, and a direction in a cone
// about it, as photons guide paths in [Jensen, Importance Driven Path Tracing using the Photon Map, 1995].
// The balance heuristic combines these rays with the others [Veach & Guibas 1995], so that the picture does
// not depend on where walks landed.
#ifndef NEARLIGHT_LIB_CAUSTIC_AIM
#define NEARLIGHT_LIB_CAUSTIC_AIM

#include "lib/bsdf/bsdf.cl"
#include "shared/caustic_aims.h"

#define CAUSTIC_PARAMETERS                                                        \
    CausticTable caustic_table, const global CausticCell *restrict caustic_cells, \
        const global Vec3 *restrict caustic_targets

/// The targets of a receiver, and how many rays it sends.
typedef struct CausticAim {
    const global Vec3* targets;
    uint count;    // of targets; 0: the receiver does not aim
    float radius;  // of the ball about a target that its cone holds, m
    float3 x;      // the receiver
    uint aimed_rays, cosine_rays;
} CausticAim;

static inline CausticAim no_caustic_aim(void) {
    CausticAim aim;
    aim.targets = 0;
    aim.count = 0;
    aim.radius = 0.0f;
    aim.x = (float3)(0.0f);
    aim.aimed_rays = aim.cosine_rays = 0;
    return aim;
}

/// The targets of the smallest cell around x that has some, for a receiver that sends so many rays.
static inline CausticAim caustic_aim_at(const CausticTable* table, const global CausticCell* cells,
                                        const global Vec3* targets, float3 x, uint aimed_rays,
                                        uint cosine_rays) {
    CausticAim aim = no_caustic_aim();
    aim.aimed_rays = aimed_rays;
    aim.cosine_rays = cosine_rays;
    for (uint level = table->size == 0 ? 0 : NEARLIGHT_CAUSTIC_LEVELS; level-- > 0;) {
        const float side = table->side / (float)(1u << level);
        const int3 at = (int3)(caustic_coordinate(x.x, side, 0.0f), caustic_coordinate(x.y, side, 0.0f),
                               caustic_coordinate(x.z, side, 0.0f));
        for (uint i = caustic_hash(at.x, at.y, at.z, level) & (table->size - 1); cells[i].count != 0;
             i = (i + 1) & (table->size - 1)) {
            const CausticCell cell = cells[i];
            if (cell.x == at.x && cell.y == at.y && cell.z == at.z && cell.level == level) {
                aim.targets = targets + cell.first;
                aim.count = cell.count;
                aim.radius = side;
                aim.x = x;
                return aim;
            }
        }
    }
    return aim;
}

/// The distance (m) of a target from the receiver, which may touch it.
static inline float distance_of(float3 to_target) {
    return fmax(length(to_target), 1e-15f);
}

/// 1 − the cosine of the half angle of the cone about a target at a distance (m): at most some 63°.
static inline float caustic_cone(const CausticAim* aim, float distance) {
    const float radius = fmin(aim->radius, 2.0f * distance);
    const float edge = sqrt(distance * distance + radius * radius);
    return radius * radius / (edge * (edge + distance));
}

/// The density of aimed rays in a direction, per steradian.
static inline float caustic_pdf(const CausticAim* aim, float3 direction) {
    float sum = 0.0f;
    for (uint i = 0; i < aim->count; ++i) {
        const float3 to_target = load3(aim->targets[i]) - aim->x;
        const float distance = distance_of(to_target);
        const float cone = caustic_cone(aim, distance);
        // With unit vectors, |a − b|² is 2·(1 − cosine), which keeps its digits in narrow cones.
        const float3 apart = direction - to_target / distance;
        sum += 0.5f * dot(apart, apart) <= cone ? 1.0f / cone : 0.0f;
    }
    return sum / (2.0f * M_PI_F * (float)aim->count);
}

/// A direction of that density. `u` is uniform in the unit square.
static inline float3 caustic_direction(const CausticAim* aim, float2 u) {
    const float place = u.x * (float)aim->count;
    const uint i = min((uint)place, aim->count - 1);
    const float3 to_target = load3(aim->targets[i]) - aim->x;
    const float distance = distance_of(to_target);
    const float below_one = (place - (float)i) * caustic_cone(aim, distance);
    return to_world_frame(cone_direction(below_one, u.y), to_target / distance);
}

/// The part that counts of what a cosine-distributed ray finds in a direction, beside the rays that aim.
static inline float unaimed_part(const CausticAim* aim, float cosine, float3 direction) {
    if (aim->count == 0) {
        return 1.0f;
    }
    const float unaimed = (float)aim->cosine_rays * cosine * M_1_PI_F;
    const float aimed = (float)aim->aimed_rays * caustic_pdf(aim, direction);
    return unaimed > 0.0f ? unaimed / (unaimed + aimed) : 0.0f;
}

/// Whether light that goes on from this surface, where scatter_ray() or a walk turned it, still came over
/// mirrors and glass alone: by a mirror image, by a refraction, or by rough glass, all of whose light counts.
static inline bool is_mirror_or_glass(const SurfaceBsdf* surface, bool is_delta) {
    return is_delta || surface->bsdf.model == NEARLIGHT_BSDF_DIELECTRIC;
}

/// The chance by which rays that aim take the rarer of the two ways on from a glass body.
#define RARE_WAY_CHANCE 0.25f

/// The number by which bsdf_sample() takes the rarer way on from a smooth glass body by at least
/// RARE_WAY_CHANCE, where `u` is uniform in [0, 1). `weight` gets what this changes the sample's weight by. A
/// reflection in glass, once drawn, counts as much as one in a mirror, but is drawn twenty times less often.
static inline float choose_way_evenly(const SurfaceBsdf* surface, float u, float* weight) {
    const Bsdf* bsdf = &surface->bsdf;
    *weight = 1.0f;
    if (bsdf->model != NEARLIGHT_BSDF_DIELECTRIC || !is_smooth(bsdf)) {
        return u;
    }
    float cos_far;
    const float cosine = clamp(dot(surface->frame.n, surface->wo), 0.0f, 1.0f);
    const float reflectance = fresnel_dielectric(cosine, bsdf->eta.x, &cos_far);
    if (!(reflectance > 0.0f && reflectance < 1.0f)) {
        return u;
    }
    const float chance = clamp(reflectance, RARE_WAY_CHANCE, 1.0f - RARE_WAY_CHANCE);
    const float rest = 1.0f - reflectance;
    *weight = u < chance ? reflectance / chance : rest / (1.0f - chance);
    return u < chance ? u / chance * reflectance
                      : fmin(reflectance + (u - chance) / (1.0f - chance) * rest, 0x1.fffffep-1f);
}

#endif
