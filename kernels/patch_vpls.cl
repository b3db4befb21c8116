// SPDX-License-Identifier: Apache-2.0
// Turns placed surface samples into patches (close-range VPLs) that are still without light. Their power is
// ρ·A/K, which an irradiance of 1 W/m² would give, where A is the area that the K samples stand for.
// kernels/vpl_light.cl brings the light.
//
// Each sample becomes two VPLs, one on each side of its surface: slots 2·i (front) and 2·i + 1 (back).
// `flags` tell which slots hold one. A slot is empty if its side reflects nothing or if, where the policy
// decides point by point, the sample lies outside the close range. One work-item for each slot; any
// work-group size.

#include "lib/close_range.cl"
#include "lib/material.cl"
#include "lib/vpl.cl"

kernel void patch_vpls(SCENE_PARAMETERS, const global SurfaceSample* restrict samples, uint sample_count,
                       const global CloseRange* restrict close_range, uint whole_triangles,
                       float area_per_sample, global Vpl* restrict vpls, global uint* restrict flags) {
    const uint index = (uint)get_global_id(0);
    if (index >= 2 * sample_count) {
        return;
    }
    const SceneView scene = SCENE_VIEW;
    flags[index] = 0;
    const SurfaceSample point = samples[index / 2];
    const bool front = index % 2 == 0;
    const global Material* material = scene.materials + scene.triangles[point.triangle].material;
    const float3 position = load3(point.position);
    if (!reflects(material, front) || !(whole_triangles || in_close_range(close_range, position))) {
        return;
    }
    const float3 power = light_albedo(&scene, material, (float2)(point.u, point.v)) * area_per_sample;
    if (is_black(power)) {
        return;
    }
    const float3 normal = front ? load3(point.normal) : -load3(point.normal);
    // Depth 0 stands for light of all depths.
    vpls[index] = make_vpl(offset_point(&scene, position, normal), normal, 0, NEARLIGHT_VPL_CLOSE, power);
    flags[index] = 1;
}
