// SPDX-License-Identifier: Apache-2.0
// Sparse quasi-random light tracing (instant radiosity) [Keller, Instant Radiosity, SIGGRAPH 1997; paper §3 (3)].
//
// One work-item a walk, first_walk and on; any work-group size. A walk leaves a light and deposits a VPL wherever
// it lands, up to bounce_count times: slot (walk − first_walk) · bounce_count + (depth − 1) of `vpls`, and 1 in the
// same slot of `flags` if it is to be kept.
// Fractional absorption: walk i goes on to depth j while i + absorption_shift < walks_at_depth[j − 1]; a VPL of
// depth j is divided by walks_at_depth[j − 1], the (real-valued) number of walks that are launched that far, never
// by how many arrive. With a uniform random shift that is unbiased for every depth.

#include "lib/close_range.cl"
#include "lib/emitter.cl"
#include "lib/material.cl"

// Which deposits a policy keeps of those in the close range (docs/method.md).
#define KEEP_ALL 0u
#define KEEP_INDIRECT_INSIDE 1u  // partition: inside the close range, depth 2 and more
#define KEEP_OUTSIDE 2u          // paper and complete: nothing inside the close range

/// Whether the close-range part answers for direct light at this point: its triangle was selected and, where the
/// policy decides point by point, the point itself lies in the region.
inline bool is_close_surface(const global CloseRange* region, const global uint* close_triangles,
                             uint whole_triangles, uint triangle, float3 position) {
    return close_triangles[triangle] && (whole_triangles || in_close_range(region, position));
}

kernel void light_tracer(SCENE_PARAMETERS, const global CloseRange* restrict close_range,
                         const global uint* restrict close_triangles, uint whole_triangles, uint keep, uint first_walk,
                         uint walk_count, uint bounce_count, const global float* restrict walks_at_depth, float absorption_shift,
                         uint seed, global Vpl* restrict vpls, global uint* restrict flags) {
    const uint index = (uint)get_global_id(0);
    if (index >= walk_count) {
        return;
    }
    const SceneView scene = SCENE_VIEW;
    for (uint bounce = 0; bounce < bounce_count; ++bounce) {
        flags[index * bounce_count + bounce] = 0;
    }
    const uint walk = first_walk + index;
    const EmittedParticle particle =
        emit_particle(&scene, sample_2d(walk, 0, seed), sample_2d(walk, 1, seed), sample_2d(walk, 2, seed));
    float3 origin = particle.origin;
    float3 direction = particle.direction;
    float3 flux = particle.flux;
    for (uint bounce = 0; bounce < bounce_count; ++bounce) {
        const float launched = walks_at_depth[bounce];
        if (!((float)walk + absorption_shift < launched) || is_black(flux)) {
            return;
        }
        const SurfaceHit hit = trace_opaque(&scene, origin, direction, INFINITY);
        if (hit.t < 0.0f) {
            return;
        }
        const global Material* material = scene.materials + hit.material;
        if (!reflects(material, hit.front)) {
            return;
        }
        flux *= light_albedo(&scene, material, hit.uv);
        const bool is_close =
            is_close_surface(close_range, close_triangles, whole_triangles, hit.triangle, hit.position);
        const bool kept = keep == KEEP_ALL || !is_close || (keep == KEEP_INDIRECT_INSIDE && bounce > 0);
        origin = offset_point(&scene, hit.position, hit.geometric);
        if (kept && !is_black(flux)) {
            Vpl vpl;
            vpl.position = store3(origin);
            vpl.depth = bounce + 1;
            vpl.normal = store3(hit.geometric);
            vpl.flags = is_close ? NEARLIGHT_VPL_CLOSE : 0;
            vpl.power = store3(flux / launched);
            vpl.pad0 = 0.0f;
            vpls[index * bounce_count + bounce] = vpl;
            flags[index * bounce_count + bounce] = 1;
        }
        direction = to_world_frame(square_to_cosine_hemisphere(sample_2d(walk, 3 + bounce, seed)), hit.geometric);
    }
}
