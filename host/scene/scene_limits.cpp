// SPDX-License-Identifier: Apache-2.0
#include "host/scene/scene_limits.h"

#include <algorithm>

#include "host/base/math.h"
#include "host/base/short_text.h"
#include "host/scene/ray_epsilon.h"

namespace nearlight::core {
namespace {

/// Rays may start this part of the scene's largest side off their surfaces before it is worth a remark.
constexpr float kVisibleOffset = 1e-3f;
/// How far rays start off most triangles that lie a metre from the origin, by triangle_stand_off().
constexpr float kOffsetAtOneMetre = 2e-6f;

/// Returns whether the light was brighter than it may be.
bool limit(Vec3& light) {
    const Vec3 before = light;
    light = {std::min(light.x, kMaxRadiance), std::min(light.y, kMaxRadiance),
             std::min(light.z, kMaxRadiance)};
    return light.x != before.x || light.y != before.y || light.z != before.z;
}

bool limit_lights(Scene& scene) {
    bool limited = limit(scene.environment.sun_radiance);
    for (Vec3& pixel : scene.environment.radiance) {
        limited |= limit(pixel);
    }
    for (Emitter& emitter : scene.delta_emitters) {
        limited |= limit(emitter.radiance);
    }
    for (Material& material : scene.materials) {
        limited |= limit(material.emission.value);
    }
    return limited;
}

void remark_distance(const Scene& scene, NoteSink& notes) {
    if (scene.triangles.empty()) {
        return;
    }
    const Aabb box = bounds(scene);
    const float extent = max_component(box.max - box.min);
    const float farthest = std::max(max_component(magnitudes(box.min)), max_component(magnitudes(box.max)));
    const float offset = kOffsetAtOneMetre * farthest;
    if (offset > kVisibleOffset * extent) {
        notes.remark(scene.source, 0,
                     "the scene is " + short_text(extent) +
                         " large but lies far from the origin, where rays start " + short_text(offset) +
                         " off surfaces, so that thin things leak; move it to the origin");
    }
}

}  // namespace

void keep_within_limits(Scene& scene, NoteSink& notes) {
    if (limit_lights(scene)) {
        notes.approximation(scene.source, 0,
                            "light brighter than " + short_text(kMaxRadiance) + " counts as that bright");
    }
    remark_distance(scene, notes);
}

}  // namespace nearlight::core
