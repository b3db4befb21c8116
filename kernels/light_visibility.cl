// SPDX-License-Identifier: Apache-2.0
// Which close-range triangles the light can reach [paper §3, "visible to the light source"].
//
// One work-item for each triangle of `ids`; any work-group size. It sets selected[id] to 1 if any light
// reaches one of a few points of the triangle on a side that reflects, and leaves the entries of other
// triangles alone. An environment's map counts as reaching all of them. This only steers where VPLs are
// placed: a triangle that is missed here is left to light tracing, so no light is lost (docs/method.md). One
// point for each area_per_point (m²) of a triangle is therefore enough, up to MAX_POINTS.

#include "lib/light/sample.cl"
#include "lib/random.cl"

#define MAX_POINTS 8u
#define LIGHTS_PER_POINT 2u  // lights that a point asks: all of them, or so many that chance picks

static inline bool reached_by(const SceneView* scene, uint index, float3 x, float3 n, float2 u) {
    if (scene->emitters[index].type == NEARLIGHT_EMITTER_ENVIRONMENT) {
        return true;  // finding the one window of a room takes more rays than it is worth
    }
    LightSample light;
    if (scene->emitters[index].type == NEARLIGHT_EMITTER_SUN) {
        const MapSample map = map_sample_towards_sun(scene, u);
        const LightReceiver at = even_receiver(x, n);
        light = sample_of_sky(scene, &at, &map);
    } else {
        light = sample_emitter(scene, index, x, u);
    }
    return dot(n, light.direction) > 0.0f && may_shine(&light) && light_is_visible(scene, x, &light);
}

static inline bool point_is_lit(const SceneView* scene, float3 x, float3 n, uint point, uint key) {
    const uint emitter_count = scene->info->emitter_count;
    const bool ask_all = emitter_count <= LIGHTS_PER_POINT;
    const uint tries = ask_all ? emitter_count : LIGHTS_PER_POINT;
    for (uint i = 0; i < tries; ++i) {
        const float2 choice = sample_2d(point * LIGHTS_PER_POINT + i, 1, key);
        const uint index = ask_all ? i : choose_emitter(scene, choice.x);
        if (reached_by(scene, index, x, n, sample_2d(point * LIGHTS_PER_POINT + i, 2, key))) {
            return true;
        }
    }
    return false;
}

kernel void light_visibility(SCENE_PARAMETERS, const global uint* restrict ids, uint id_count,
                             float area_per_point, uint seed, global uint* restrict selected) {
    const uint index = (uint)get_global_id(0);
    if (index >= id_count) {
        return;
    }
    const SceneView scene = SCENE_VIEW;
    const uint id = ids[index];
    const global Material* material = scene.materials + scene.triangles[id].material;
    const uint key = random_uint4((uint4)(id, seed, 0x715u, 0x1u)).x;
    const bool front = (material->flags & NEARLIGHT_MATERIAL_DIFFUSE_FRONT) != 0;
    const bool back = (material->flags & NEARLIGHT_MATERIAL_DIFFUSE_BACK) != 0;
    const uint point_count = (uint)clamp(triangle_area(&scene, id) / area_per_point, 1.0f, (float)MAX_POINTS);
    const float stand_off = triangle_stand_off(&scene, id);
    for (uint i = 0; i < point_count; ++i) {
        float3 normal;
        const float3 point = triangle_point(&scene, id, square_to_triangle(sample_2d(i, 0, key)), &normal);
        if ((front && point_is_lit(&scene, point + stand_off * normal, normal, i, key)) ||
            (back && point_is_lit(&scene, point - stand_off * normal, -normal, i, key))) {
            selected[id] = 1;
            return;
        }
    }
}
