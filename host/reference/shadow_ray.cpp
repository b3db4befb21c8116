// SPDX-License-Identifier: Apache-2.0
#include "host/reference/shadow_ray.h"

#include <algorithm>

#include "host/reference/bsdf/veil.h"
#include "host/reference/surface.h"

namespace nearlight::core {

ShadowRay shadow_ray(const Scene& scene, const EmbreeScene& embree, Vec3 position, const LightPick& pick,
                     int max_veils, Vec3 scene_size) {
    if (pick.is_delta && !scene.clear_glass && !scene.open_veils) {
        max_veils = 0;
    }
    max_veils = std::min(max_veils, NEARLIGHT_MAX_VEILS);
    const bool is_open = LightSampler::is_visible(embree, position, pick);
    if (is_open || max_veils <= 0) {
        return {.transmittance = is_open ? Vec3d{1, 1, 1} : Vec3d{}};
    }
    const float distance = pick.infinite ? kInfinity : length(pick.target - position);
    const Vec3 direction = pick.infinite ? pick.direction : (pick.target - position) / distance;
    const float t_max = distance * NEARLIGHT_SEGMENT_T_MAX;
    float t_min = pick.infinite ? 0.0f : distance * NEARLIGHT_SEGMENT_T_MIN;
    ShadowRay ray{.transmittance = {1, 1, 1}};
    for (;;) {
        const BvhHit hit = embree.closest_hit(position, direction, t_min, t_max);
        if (hit.triangle == ~0u) {
            return ray;
        }
        const Surface surface = surface_at(scene, hit, direction);
        ray.transmittance *= veil_transmittance(scene, surface, normalize(as_double(direction)));
        if (ray.veils++ == max_veils || is_zero(ray.transmittance)) {
            return {};
        }
        // Here a ray would start that left the veil's other side.
        const float cosine = std::abs(dot(surface.geometric_normal, direction));
        t_min = hit.t + surface.stand_off(scene_size) / std::max(cosine, NEARLIGHT_MIN_GRAZING_COSINE);
    }
}

}  // namespace nearlight::core
