// SPDX-License-Identifier: Apache-2.0
// All the light that arrives at receivers, direct and after any number of bounces: by next-event estimation, from VPLs,
// and by short paths for what bounding those takes away (lib/path_walk.cl).
//
// One work-item a receiver; any work-group size. Absent receivers (zero normal) get 0. Random numbers are keyed by the
// receiver's position, so no split of the work changes the result.

#include "lib/path_walk.cl"

kernel void path_light(SCENE_PARAMETERS, const global ReceiverPacket* restrict receivers, uint packet_count,
                       const global Vpl* restrict vpls, uint vpl_count, uint connections, float radius,
                       uint path_count, uint bounce_count, uint direct_samples, uint seed,
                       global IrradiancePacket* restrict irradiance) {
    const uint index = (uint)get_global_id(0);
    const uint packet = index / NEARLIGHT_PACKET_SIZE;
    const uint lane = index % NEARLIGHT_PACKET_SIZE;
    if (packet >= packet_count) {
        return;
    }
    const SceneView scene = SCENE_VIEW;
    const global ReceiverPacket* receiver = receivers + packet;
    const float3 x = (float3)(receiver->px[lane], receiver->py[lane], receiver->pz[lane]);
    const float3 n = (float3)(receiver->nx[lane], receiver->ny[lane], receiver->nz[lane]);
    float3 e = (float3)(0.0f);
    if (dot(n, n) > 0.0f && scene.info->emitter_count > 0) {
        const Connections to = {vpls, vpl_count, connections, radius};
        const uint4 keys = random_uint4((uint4)(as_uint(x.x), as_uint(x.y), as_uint(x.z), seed));
        for (uint path = 0; path < path_count; ++path) {
            e += short_walk_irradiance(&scene, &to, x, n, bounce_count, direct_samples, keys.x + path) /
                 (float)path_count;
        }
    }
    irradiance[packet].r[lane] = e.x;
    irradiance[packet].g[lane] = e.y;
    irradiance[packet].b[lane] = e.z;
}
