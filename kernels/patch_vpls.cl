// SPDX-License-Identifier: Apache-2.0
// Turns placed surface samples into patches (close-range VPLs) that are still without light. Their power is
// ρ·A/K, which an irradiance of 1 W/m² would give, where A is the area that the K samples stand for.
// kernels/vpl_light.cl brings the light.
//
// Each sample becomes two VPLs, one on each side of its surface: slots 2·i (front) and 2·i + 1 (back).
// `flags` tell which slots hold one. A slot is empty if its side reflects nothing or if, where the policy
// decides point by point, the sample lies outside the close range. One work-item for each slot; any
// work-group size.

#include "lib/bsdf/bsdf.cl"
#include "lib/close_range.cl"
#include "lib/random.cl"
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
    const float3 position = load3(point.position);
    if (!(whole_triangles || in_close_range(close_range, position))) {
        return;
    }
    const SurfaceHit hit =
        surface_at(&scene, point.triangle, (float2)(point.u, point.v), position, load3(point.normal), front);
    const uint4 random =
        random_uint4((uint4)(as_uint(position.x), as_uint(position.y), as_uint(position.z), 0x9a7c4u));
    const SurfaceBsdf surface =
        surface_bsdf(&scene, &hit, -hit.geometric, BSDF_RADIANCE, to_unit_float(random.x));
    const float3 power = surface.bsdf.diffuse * area_per_sample;
    if (is_black(power)) {
        return;
    }
    // Depth 0 stands for light of all depths.
    vpls[index] = make_vpl(off_surface(&hit, hit.geometric), hit.geometric, surface.frame.n,
                           surface.bsdf.curve, 0, NEARLIGHT_VPL_CLOSE | mapped_flag(&surface), power);
    flags[index] = 1;
}
