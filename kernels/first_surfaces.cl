// SPDX-License-Identifier: Apache-2.0
// First surfaces: which triangle each camera sample sees first, for mattes of objects and materials.
//
// Samples are those of the camera pass, to the bit. Holes of masks and `null` let them through by the same
// random numbers as there; glass is a surface. One work-item for each sample of the window; any work-group
// size. Results are in the order of the pixels, row by row, with the samples of a pixel one after the other.

#include "lib/bsdf/bsdf.cl"
#include "lib/camera_sample.cl"
#include "lib/light/triangle.cl"

#define MAX_ABSENT 24  // surfaces that are not there, on one ray

/// Whether a surface is not there for the path that begins with `start`. What shines there can be seen.
static inline bool is_absent(const SceneView* scene, const SurfaceHit* hit, const CameraSample* start,
                             uint step) {
    const uint model = scene->materials[hit->material].model;
    if ((model < NEARLIGHT_BSDF_MASK && model != NEARLIGHT_BSDF_NULL) ||
        max_component(emitted_radiance(scene, hit)) > 0.0f) {
        return false;
    }
    const float u = model_number(start->number, surface_key(start->pixel_key, step));
    return surface_bsdf(scene, hit, start->ray.direction, BSDF_CAMERA, u).bsdf.model == NEARLIGHT_BSDF_NULL;
}

static inline SurfaceHit first_seen(const SceneView* scene, const global Camera* camera,
                                    const CameraSample* start) {
    SurfaceHit hit = trace_first(scene, camera, &start->ray);
    for (uint step = 0; hit.t >= 0.0f && is_absent(scene, &hit, start, step); ++step) {
        const float3 origin = ray_origin(&hit, start->ray.direction);
        hit = step < MAX_ABSENT ? trace_surface(scene, origin, start->ray.direction, INFINITY) : no_surface();
    }
    return hit;
}

/// Writes for each sample from first_sample on the index of the triangle that it sees first, or ~0 if there
/// is none. The samples of a pixel count alike, as in the film's layers of surfaces.
kernel void first_surfaces(SCENE_PARAMETERS, const global Camera* restrict camera, uint first_column,
                           uint first_row, uint width, uint row_count, uint first_sample, uint sample_count,
                           uint in_middle, uint seed, global uint* restrict triangles) {
    const uint index = (uint)get_global_id(0);
    const uint pixel = index / sample_count;
    if (pixel >= width * row_count) {
        return;
    }
    const SceneView scene = SCENE_VIEW;
    const CameraSample start = camera_sample(camera, first_column + pixel % width, first_row + pixel / width,
                                             first_sample + index % sample_count, in_middle, seed);
    const SurfaceHit hit = first_seen(&scene, camera, &start);
    triangles[index] = hit.t >= 0.0f ? hit.triangle : ~0u;
}
