// SPDX-License-Identifier: Apache-2.0
// Light of the sky that a bundle of receivers shares (shared_sky.cl).
//
// The sky is a sphere around the scene. A ray of a receiver that meets nothing finds a light y on it, which
// is the sky in the direction of y to any receiver of the bundle. So it can be treated as a light of a place:
// the segment from y to a receiver has a geometry term, and the density of all rays of the bundle is the sum
// of these terms over the receivers that see y.
#ifndef NEARLIGHT_LIB_SHARED_SKY
#define NEARLIGHT_LIB_SHARED_SKY

#include "lib/light/sample.cl"
#include "lib/shared_light.cl"

/// Where a ray from x leaves the sphere around the scene, with the inward normal. The sphere is a little
/// larger than the scene, so that all segments end off its surfaces.
static inline float3 sky_place(const SceneView* scene, float3 x, float3 direction, float3* normal) {
    const float3 center = load3(scene->environment->scene_center);
    const float radius = 1.01f * scene->environment->scene_radius;
    const float3 from = x - center;
    const float along = dot(from, direction);
    const float rest = (radius - length(from)) * (radius + length(from));
    const float t = sqrt(fmax(along * along + rest, 0.0f)) - along;
    const float3 out = from + t * direction;
    *normal = -normalize(out);
    return center + out;
}

/// Takes the sky that a ray from x met into the draw. All finds have the same weight, however dark the sky is
/// where this ray met it: other receivers see another part of it behind the same place.
static inline void offer_sky(const SceneView* scene, float3 x, float3 direction, float u, FoundLight* sky) {
    float3 normal;
    SharedLight light;
    light.position = store3(sky_place(scene, x, direction, &normal));
    light.weight = 1.0f;
    light.normal = store3(normal);
    light.curve = light.veils = 0;
    light.radiance = store3((float3)(1.0f));
    light.shading = pack_direction(normal);
    offer_light(sky, &light, u);
}

#endif
