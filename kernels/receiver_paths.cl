// SPDX-License-Identifier: Apache-2.0
// All light of receivers except what VPLs bring (lib/receiver_path.cl): direct light, and, if each receiver
// sends rays, the remainder.
//
// One work-item for each receiver; any work-group size. Absent receivers (zero normal) get 0. Receivers of
// one pixel share a sequence of random numbers, and each takes its own part of it, so that all samples of the
// pixel are evenly spread. Other receivers have numbers of their own, keyed by position. So no split of the
// work changes the result. A receiver with `surfaces` surfaces before it gets paths of at most max_edges −
// surfaces edges. VPLs bring it longer ones, whose light the rays take away again.
//
// `shares` says with NEARLIGHT_SHARES_… what goes not to the receiver, but to one light of each kind, for
// shared_lights.cl, shared_sky.cl, shared_veiled.cl and shared_reflections.cl to take further. Reflections
// want the `spacing` of each receiver, which receiver_spacing finds: one work-item for each `part` receivers
// of a bundle, where `part` must divide BUNDLE_RECEIVERS; any work-group size.
//
// caustic_errors says what receivers gain if they aim at mirrors and glass.

#include "lib/lanes.cl"
#include "lib/receiver_path.cl"
#include "shared/receiver_paths.h"

/// Says what a receiver leaves to its bundle. `spacing` is read only if it leaves reflections there.
static inline void want_finds(Finds* finds, const SceneView* scene, uint shares,
                              const global float* spacing) {
    finds->near.is_wanted = (shares & NEARLIGHT_SHARES_NEAR) != 0;
    finds->sky.is_wanted = (shares & NEARLIGHT_SHARES_SKY) != 0 && scene->info->has_sky;
    finds->veiled.is_wanted = (shares & NEARLIGHT_SHARES_VEILED) != 0;
    finds->reflections.light.is_wanted = (shares & NEARLIGHT_SHARES_REFLECTIONS) != 0;
    finds->reflections.spacing = finds->reflections.light.is_wanted ? *spacing : 0.0f;
}

static inline PathLimits receiver_limits(const ReceiverPathParams* params,
                                         const global ReceiverPacket* receiver, uint lane, bool shares_sky) {
    const uint max_edges = params->max_edges;
    const uint surfaces = receiver_surfaces(receiver, lane);
    const uint own_edges = max_edges > surfaces ? max_edges - surfaces : 0;
    const PathLimits limits = {.max_edges = own_edges,
                               .vpl_edges = max_edges < LONG_PATH ? max_edges : own_edges,
                               .clamp_radius = params->clamp_radius,
                               .light_samples = params->light_samples,
                               .rays = params->rays,
                               .bundle_rays = shares_sky ? NEARLIGHT_SKY_RAYS * params->rays : 0,
                               .sample = receiver_sample(receiver, lane),
                               .shared_limit = params->shared_limit,
                               .aim = no_caustic_aim()};
    return limits;
}

static inline ReceiverPoint receiver_point_of(const global ReceiverPacket* receiver, uint lane) {
    ReceiverPoint at;
    at.x = receiver_position(receiver, lane);
    at.n = receiver_normal(receiver, lane);
    at.mesh_n = receiver_mesh_normal(receiver, lane);
    at.curve = receiver_curve(receiver, lane);
    return at;
}

/// The random numbers of a receiver.
static inline uint4 receiver_keys(const global ReceiverPacket* receiver, uint lane, float3 x, uint seed) {
    const uint sequence = receiver->sequence[lane];
    return random_uint4(sequence != 0 ? (uint4)(sequence, 0x9e1fu, 0x70a7u, seed)
                                      : (uint4)(as_uint(x.x), as_uint(x.y), as_uint(x.z), seed));
}

kernel void receiver_paths(SCENE_PARAMETERS, VEIL_PARAMETERS, const global ReceiverPacket* restrict receivers,
                           ReceiverPathParams params, global IrradiancePacket* restrict direct,
                           global IrradiancePacket* restrict indirect,
                           global SharedLight* restrict found_near, global SharedLight* restrict found_sky,
                           global SharedLight* restrict found_veiled,
                           global SharedLight* restrict found_reflections,
                           global SharedReflection* restrict reflections,
                           const global float* restrict spacing, CAUSTIC_PARAMETERS) {
    const uint index = (uint)get_global_id(0);
    const uint packet = index / NEARLIGHT_PACKET_SIZE;
    const uint lane = index % NEARLIGHT_PACKET_SIZE;
    if (packet >= params.packet_count) {
        return;
    }
    const SceneView scene = SCENE_VIEW;
    const global ReceiverPacket* receiver = receivers + packet;
    const ReceiverPoint at = receiver_point_of(receiver, lane);
    ReceivedLight light = nothing_received();
    Finds finds = nothing_shared();
    const SceneView solids = solids_alone(scene);
    const SceneView veils = VEIL_VIEW(scene);
    finds.solids = &solids;
    finds.veils = &veils;
    if (params.shares != 0 && receiver_shares(receiver, lane, params.max_edges)) {
        want_finds(&finds, &scene, params.shares, spacing + index);
    }
    if (dot(at.n, at.n) > 0.0f) {
        PathLimits limits = receiver_limits(&params, receiver, lane, finds.sky.is_wanted);
        if (params.aimed_rays > 0) {
            limits.aim = caustic_aim_at(&caustic_table, caustic_cells, caustic_targets, at.x,
                                        params.aimed_rays, params.rays);
        }
        light =
            received_light(&scene, &at, &limits, receiver_keys(receiver, lane, at.x, params.seed), &finds);
    }
    store_irradiance(direct + packet, lane, light.direct);
    store_irradiance(indirect + packet, lane, light.indirect);
    if (params.shares & NEARLIGHT_SHARES_NEAR) {
        found_near[index] = kept_light(&finds.near);
    }
    if (params.shares & NEARLIGHT_SHARES_SKY) {
        found_sky[index] = kept_light(&finds.sky);
    }
    if (params.shares & NEARLIGHT_SHARES_VEILED) {
        found_veiled[index] = kept_light(&finds.veiled);
    }
    if (params.shares & NEARLIGHT_SHARES_REFLECTIONS) {
        found_reflections[index] = kept_light(&finds.reflections.light);
        reflections[index] = finds.reflections.surface;
    }
}

/// Estimates of the squared error of light over mirrors and glass: squared W/m², summed over the channels.
typedef struct CausticError {
    float unaimed;  // where receivers send cosine-distributed rays alone
    float aimed;    // where they aim rays besides
    float chance;   // that a cosine-distributed ray meets such light
} CausticError;

/// Adds what an aimed ray says. `u` is uniform in the unit square.
///
/// A ray in the direction ω, in which a cosine-distributed ray brings C(ω), has the densities p of those and
/// q of aimed ones. With n cosine-distributed and m aimed rays, the second moment of what they bring is ∫
/// C²·p² ÷ (n·p + m·q) dω by the balance heuristic, and ∫ C²·p ÷ n dω without aimed rays. An aimed ray
/// estimates both, and with them the chance ∫ p dω over all directions where C is not 0.
static inline void add_caustic_error(CausticError* sum, const SceneView* scene, const ReceiverPoint* at,
                                     const PathLimits* limits, float2 u, uint4 keys) {
    const CausticAim* aim = &limits->aim;
    const float3 light = aimed_light(scene, at, limits, u, keys);
    const float3 direction = caustic_direction(aim, u);
    const float part = unaimed_part(aim, dot(at->n, direction), direction);  // n·p ÷ (n·p + m·q)
    if (is_black(light) || !(part > 0.0f && part < 1.0f)) {
        return;
    }
    const float n = (float)aim->cosine_rays;
    const float ratio = (float)aim->aimed_rays / ((1.0f - part) * n);  // p ÷ q ÷ part
    const float error = dot(light, light) * ratio / n;                 // because light is part·C
    sum->unaimed += error / part;
    sum->aimed += error;
    sum->chance += part * ratio;
}

/// The errors of receivers without aimed rays and with them, by NEARLIGHT_CAUSTIC_ERROR_RAYS aimed rays of
/// each, because cosine-distributed ones seldom meet what makes the error. The variance lacks the square of
/// the mean, which is at most the chance times the second moment.
///
/// One work-item for each receiver; any work-group size.
kernel void caustic_errors(SCENE_PARAMETERS, const global ReceiverPacket* restrict receivers,
                           ReceiverPathParams params, global float* restrict unaimed,
                           global float* restrict aimed, CAUSTIC_PARAMETERS) {
    const uint index = (uint)get_global_id(0);
    const uint packet = index / NEARLIGHT_PACKET_SIZE;
    const uint lane = index % NEARLIGHT_PACKET_SIZE;
    if (packet >= params.packet_count) {
        return;
    }
    const SceneView scene = SCENE_VIEW;
    const ReceiverPoint at = receiver_point_of(receivers + packet, lane);
    CausticError sum = {0.0f, 0.0f, 0.0f};
    if (dot(at.n, at.n) > 0.0f) {
        PathLimits limits = receiver_limits(&params, receivers + packet, lane, false);
        limits.aim = caustic_aim_at(&caustic_table, caustic_cells, caustic_targets, at.x, params.aimed_rays,
                                    params.rays);
        const uint4 keys = receiver_keys(receivers + packet, lane, at.x, params.seed);
        for (uint ray = 0; limits.aim.count > 0 && ray < NEARLIGHT_CAUSTIC_ERROR_RAYS; ++ray) {
            add_caustic_error(&sum, &scene, &at, &limits, sample_2d(ray, 3, keys.x),
                              random_uint4((uint4)(keys.y, keys.z, ~keys.w, ray)));
        }
    }
    const float of_variance = fmax(1.0f - sum.chance / NEARLIGHT_CAUSTIC_ERROR_RAYS, 0.0f);
    unaimed[index] = of_variance * sum.unaimed / NEARLIGHT_CAUSTIC_ERROR_RAYS;
    aimed[index] = of_variance * sum.aimed / NEARLIGHT_CAUSTIC_ERROR_RAYS;
}

#define BUNDLE_ROWS (BUNDLE_RECEIVERS / 16)

/// Where the receivers of a bundle are that share lights; +∞ stands for others.
typedef struct SharingPlaces {
    float x[BUNDLE_RECEIVERS], y[BUNDLE_RECEIVERS], z[BUNDLE_RECEIVERS];
    uint count;
    float squared_extent;  // of the box around them: the square of its diagonal, m²
} SharingPlaces;

static inline void find_sharing_places(SharingPlaces* places, const global ReceiverPacket* receivers,
                                       const Bundle* bundle, uint max_edges) {
    float3 low = (float3)(INFINITY);
    float3 high = (float3)(-INFINITY);
    places->count = 0;
    for (uint lane = 0; lane < BUNDLE_RECEIVERS; ++lane) {
        float3 x = (float3)(INFINITY);
        if (bundle_receiver_shares(receivers, bundle, lane, max_edges)) {
            x = receiver_position(receivers + bundle->first + lane / NEARLIGHT_PACKET_SIZE,
                                  lane % NEARLIGHT_PACKET_SIZE);
            low = fmin(low, x);
            high = fmax(high, x);
            ++places->count;
        }
        places->x[lane] = x.x;
        places->y[lane] = x.y;
        places->z[lane] = x.z;
    }
    places->squared_extent = dot(high - low, high - low);
}

/// The radius (m) of the neighbourhood of a receiver that shares: a sphere around it that holds at least a
/// quarter of those that share. Half the squared radius would hold fewer.
static inline float neighbourhood_radius(const SharingPlaces* places, uint lane) {
    float16 squared[BUNDLE_ROWS];
    for (uint row = 0; row < BUNDLE_ROWS; ++row) {
        const float16 x = vload16(row, places->x) - places->x[lane];
        const float16 y = vload16(row, places->y) - places->y[lane];
        const float16 z = vload16(row, places->z) - places->z[lane];
        squared[row] = x * x + y * y + z * z;
    }
    for (float limit = fmin(places->squared_extent, FLT_MAX);; limit *= 0.5f) {
        uint inside = 0;
        for (uint row = 0; row < BUNDLE_ROWS; ++row) {
            inside += popcount(lane_bits16(squared[row] < 0.5f * limit));
        }
        if (4 * inside < places->count) {
            return sqrt(limit);
        }
    }
}

kernel void receiver_spacing(const global ReceiverPacket* restrict receivers, uint packet_count,
                             uint max_edges, uint part, global float* restrict spacing) {
    const uint first = (uint)get_global_id(0) * part;
    const Bundle bundle = bundle_at(first / BUNDLE_RECEIVERS, packet_count);
    const uint first_lane = first % BUNDLE_RECEIVERS;
    const uint end_lane = min(first_lane + part, bundle.count * NEARLIGHT_PACKET_SIZE);
    if (first_lane >= end_lane) {
        return;
    }
    SharingPlaces places;
    find_sharing_places(&places, receivers, &bundle, max_edges);
    for (uint lane = first_lane; lane < end_lane; ++lane) {
        spacing[bundle.first * NEARLIGHT_PACKET_SIZE + lane] =
            places.x[lane] < INFINITY ? neighbourhood_radius(&places, lane) : 0.0f;
    }
}
