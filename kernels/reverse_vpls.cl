// SPDX-License-Identifier: Apache-2.0
// Reverse VPLs [Segovia et al., Bidirectional Instant Radiosity, EGSR 2006]. A VPL lights the picture where
// rays from points that the camera sees land.
//
// Each of the points s sends m cosine-distributed rays. What lands at y has the density (per area, of all
// rays together)
//
//     n(y) = Σ_s m · cosθs·cosθy / (π d²) · V(s, y),
//
// with the sum over exactly those points. It is the irradiance that a gather brings to y from the points as
// VPLs of power m.
//
// One work-item for each ray; ray r belongs to point r / m. Where it lands on a surface that reflects, slot r
// of `vpls` gets a VPL whose power is the albedo there, and slot r of `flags` gets 1. Any work-group size.

#include "lib/bsdf/bsdf.cl"
#include "lib/random.cl"
#include "lib/sampling.cl"
#include "lib/vpl.cl"

kernel void reverse_vpls(SCENE_PARAMETERS, const global Importon* restrict points, uint point_count,
                         uint rays_per_point, uint seed, global Vpl* restrict vpls,
                         global uint* restrict flags) {
    const uint ray = (uint)get_global_id(0);
    if (ray >= point_count * rays_per_point) {
        return;
    }
    flags[ray] = 0;
    const SceneView scene = SCENE_VIEW;
    const global Importon* point = points + ray / rays_per_point;
    const float3 origin = load3(point->position);
    // All points use one sequence, so that neighbouring points, which look the same way, share the directions
    // among them.
    const float3 direction =
        to_world_frame(square_to_cosine_hemisphere(sample_2d(ray, 0, seed)), load3(point->normal));
    const SurfaceHit hit = trace_surface(&scene, origin, direction, INFINITY);
    if (hit.t < 0.0f) {
        return;
    }
    const SurfaceBsdf surface =
        surface_bsdf(&scene, &hit, -hit.geometric, BSDF_RADIANCE, sample_2d(ray, 1, seed).x);
    const float3 albedo = surface.bsdf.diffuse;
    const float3 y = off_surface(&hit, hit.geometric);
    // A shading normal lets a ray leave below the surface of its own point. Such a ray comes from the plane
    // of y; local_geometry() in local_lights.cl has the same bound of what counts as one plane.
    const float height = dot(hit.geometric, origin - y);
    if (is_black(albedo) || !(height > 0.3f * epsilon_about(&scene, y, hit.t))) {
        return;
    }
    // Depth 0 stands for light of all depths.
    vpls[ray] =
        make_vpl(y, hit.geometric, surface.frame.n, surface.bsdf.curve, 0, mapped_flag(&surface), albedo);
    flags[ray] = 1;
}
