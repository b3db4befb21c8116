// SPDX-License-Identifier: Apache-2.0
// From placed surface samples to close-range VPLs [paper eq. 2, repaired: angle and distance are to the light].
//
// patch_receivers: each sample becomes two receivers, one on each side of its surface: sample i lies in packet
// 2·(i / 64) (front) and the next one (back), lane i % 64. Sides that reflect nothing, samples outside the close
// range (where the policy decides point by point) and lanes beyond the last sample are absent.
// patch_vpls: irradiance E of those receivers becomes VPLs of power Φ = ρ·E·A/K, A the area the samples stand
// for and K their number; flags tell which of the 2·64·packets slots hold one.
// One work-item a receiver lane; any work-group size.

#include "lib/close_range.cl"
#include "lib/material.cl"

inline bool side_of_lane(uint index, uint sample_count, uint* sample, uint* front) {
    const uint packet = index / NEARLIGHT_PACKET_SIZE;
    *sample = packet / 2 * NEARLIGHT_PACKET_SIZE + index % NEARLIGHT_PACKET_SIZE;
    *front = packet % 2 == 0;
    return *sample < sample_count;
}

kernel void patch_receivers(SCENE_PARAMETERS, const global SurfaceSample* restrict samples, uint sample_count,
                            const global CloseRange* restrict close_range, uint whole_triangles, uint lane_count,
                            global ReceiverPacket* restrict receivers) {
    const uint index = (uint)get_global_id(0);
    if (index >= lane_count) {
        return;
    }
    const SceneView scene = SCENE_VIEW;
    global ReceiverPacket* packet = receivers + index / NEARLIGHT_PACKET_SIZE;
    const uint lane = index % NEARLIGHT_PACKET_SIZE;
    float3 position = (float3)(0.0f);
    float3 normal = (float3)(0.0f);
    uint sample, front;
    if (side_of_lane(index, sample_count, &sample, &front)) {
        const SurfaceSample point = samples[sample];
        const global Material* material = scene.materials + scene.triangles[point.triangle].material;
        const float3 p = load3(point.position);
        if (reflects(material, front) && (whole_triangles || in_close_range(close_range, p))) {
            normal = front ? load3(point.normal) : -load3(point.normal);
            position = offset_point(&scene, p, normal);
        }
    }
    packet->px[lane] = position.x;
    packet->py[lane] = position.y;
    packet->pz[lane] = position.z;
    packet->nx[lane] = normal.x;
    packet->ny[lane] = normal.y;
    packet->nz[lane] = normal.z;
}

kernel void patch_vpls(SCENE_PARAMETERS, const global SurfaceSample* restrict samples, uint sample_count,
                       const global ReceiverPacket* restrict receivers,
                       const global IrradiancePacket* restrict irradiance, float area_per_sample, uint lane_count,
                       global Vpl* restrict vpls, global uint* restrict flags) {
    const uint index = (uint)get_global_id(0);
    if (index >= lane_count) {
        return;
    }
    const SceneView scene = SCENE_VIEW;
    flags[index] = 0;
    uint sample, front;
    if (!side_of_lane(index, sample_count, &sample, &front)) {
        return;
    }
    const global ReceiverPacket* packet = receivers + index / NEARLIGHT_PACKET_SIZE;
    const global IrradiancePacket* light = irradiance + index / NEARLIGHT_PACKET_SIZE;
    const uint lane = index % NEARLIGHT_PACKET_SIZE;
    const float3 e = (float3)(light->r[lane], light->g[lane], light->b[lane]);
    const SurfaceSample point = samples[sample];
    const global Material* material = scene.materials + scene.triangles[point.triangle].material;
    const float3 power = light_albedo(&scene, material, (float2)(point.u, point.v)) * e * area_per_sample;
    if (is_black(power)) {
        return;
    }
    Vpl vpl;
    vpl.position.x = packet->px[lane];
    vpl.position.y = packet->py[lane];
    vpl.position.z = packet->pz[lane];
    vpl.depth = 1;
    vpl.normal.x = packet->nx[lane];
    vpl.normal.y = packet->ny[lane];
    vpl.normal.z = packet->nz[lane];
    vpl.flags = NEARLIGHT_VPL_CLOSE;
    vpl.power = store3(power);
    vpl.pad0 = 0.0f;
    vpls[index] = vpl;
    flags[index] = 1;
}
