// SPDX-License-Identifier: Apache-2.0
// All light of receivers except what VPLs bring (lib/receiver_path.cl): direct light, and, if each receiver
// sends rays, the remainder.
//
// One work-item for each receiver; any work-group size. Absent receivers (zero normal) get 0. Receivers of
// one pixel share a sequence of random numbers, and each takes its own part of it, so that all samples of the
// pixel are evenly spread. Other receivers have numbers of their own, keyed by position. So no split of the
// work changes the result. A receiver with `surfaces` surfaces before it gets paths of at most max_edges −
// surfaces edges. VPLs bring it longer ones, whose light the rays take away again. With `shares`, the
// Lambertian light of near places goes to one light of each receiver, which shared_lights.cl takes further,
// and if it is 2, the sky that rays meet goes to another one, for shared_sky.cl.

#include "lib/receiver_path.cl"

inline void store_light(global IrradiancePacket* packet, uint lane, float3 light) {
    packet->r[lane] = light.x;
    packet->g[lane] = light.y;
    packet->b[lane] = light.z;
}

kernel void receiver_paths(SCENE_PARAMETERS, const global ReceiverPacket* restrict receivers,
                           uint packet_count, uint light_samples, uint path_count, uint max_edges,
                           float clamp_radius, uint seed, uint shares,
                           global IrradiancePacket* restrict direct,
                           global IrradiancePacket* restrict indirect, global SharedLight* restrict found,
                           global SharedLight* restrict found_sky) {
    const uint index = (uint)get_global_id(0);
    const uint packet = index / NEARLIGHT_PACKET_SIZE;
    const uint lane = index % NEARLIGHT_PACKET_SIZE;
    if (packet >= packet_count) {
        return;
    }
    const SceneView scene = SCENE_VIEW;
    const global ReceiverPacket* receiver = receivers + packet;
    ReceiverPoint at;
    at.x = receiver_position(receiver, lane);
    at.n = receiver_normal(receiver, lane);
    at.mesh_n = receiver_mesh_normal(receiver, lane);
    at.curve = receiver_curve(receiver, lane);
    ReceivedLight light = nothing_received();
    const bool does_share = shares != 0 && receiver_shares(receiver, lane, max_edges);
    FoundLight shared = nothing_found(does_share);
    FoundLight sky = nothing_found(does_share && shares > 1 && scene.info->has_sky);
    if (dot(at.n, at.n) > 0.0f) {
        const uint surfaces = receiver_surfaces(receiver, lane);
        const uint own_edges = max_edges > surfaces ? max_edges - surfaces : 0;
        const PathLimits limits = {own_edges,
                                   max_edges < LONG_PATH ? max_edges : own_edges,
                                   clamp_radius,
                                   light_samples,
                                   path_count,
                                   sky.is_wanted ? NEARLIGHT_SKY_RAYS * path_count : 0,
                                   receiver_sample(receiver, lane)};
        const uint sequence = receiver->sequence[lane];
        const uint4 key = sequence != 0 ? (uint4)(sequence, 0x9e1fu, 0x70a7u, seed)
                                        : (uint4)(as_uint(at.x.x), as_uint(at.x.y), as_uint(at.x.z), seed);
        light = received_light(&scene, &at, &limits, random_uint4(key), &shared, &sky);
    }
    store_light(direct + packet, lane, light.direct);
    store_light(indirect + packet, lane, light.indirect);
    if (shares != 0) {
        found[index] = kept_light(&shared);
        found_sky[index] = kept_light(&sky);
    }
}
