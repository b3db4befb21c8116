// SPDX-License-Identifier: Apache-2.0
// Direct light: irradiance of receivers from all lights, with shadow rays.
//
// One work-item for each receiver; any work-group size. Absent receivers (zero normal) get 0. Random numbers
// are keyed by the receiver's position, so no split of the work changes the result.

#include "lib/light/direct.cl"
#include "lib/vpl.cl"

kernel void direct_light(SCENE_PARAMETERS, const global ReceiverPacket* restrict receivers, uint packet_count,
                         uint sample_count, uint seed, global IrradiancePacket* restrict irradiance) {
    const uint index = (uint)get_global_id(0);
    const uint packet = index / NEARLIGHT_PACKET_SIZE;
    const uint lane = index % NEARLIGHT_PACKET_SIZE;
    if (packet >= packet_count) {
        return;
    }
    const SceneView scene = SCENE_VIEW;
    const global ReceiverPacket* receiver = receivers + packet;
    const float3 x = receiver_position(receiver, lane);
    const float3 n = receiver_normal(receiver, lane);
    float3 e = (float3)(0.0f);
    if (dot(n, n) > 0.0f && scene.info->emitter_count > 0) {
        const uint4 keys = random_uint4((uint4)(as_uint(x.x), as_uint(x.y), as_uint(x.z), seed));
        e = direct_irradiance(&scene, x, n, sample_count, keys.x);
    }
    irradiance[packet].r[lane] = e.x;
    irradiance[packet].g[lane] = e.y;
    irradiance[packet].b[lane] = e.z;
}
