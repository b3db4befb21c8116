// SPDX-License-Identifier: Apache-2.0
#include "host/scene/default_view.h"

namespace nearlight::core {
namespace {

constexpr double kFieldOfView = 45.0;
// The direction from the middle of the box towards the camera.
constexpr Vec3 kTowardsCamera{0.45f, 0.4f, 0.8f};

bool has_light(const Scene& scene) {
    return scene.environment.width > 0 || !scene.delta_emitters.empty() ||
           std::any_of(scene.materials.begin(), scene.materials.end(),
                       [](const Material& material) { return !is_zero(material.emission.value); });
}

float radius_of(const Aabb& box) {
    return std::max(0.5f * length(box.size()), 1e-3f);
}

}  // namespace

SceneCamera default_camera(const Aabb& box) {
    SceneCamera camera;
    camera.fov_x_degrees = kFieldOfView;
    const float half_height = std::tan(degrees_to_radians(static_cast<float>(kFieldOfView) / 2)) *
                              static_cast<float>(camera.height) / static_cast<float>(camera.width);
    const float distance = radius_of(box) / std::sin(std::atan(half_height));
    const Vec3 target = box.center();
    const Vec3 origin = target + normalize(kTowardsCamera) * distance;
    camera.to_world = look_at({origin.x, origin.y, origin.z}, {target.x, target.y, target.z}, {0, 1, 0});
    return camera;
}

void add_default_view(Scene& scene, NoteSink& notes) {
    scene.camera = default_camera(bounds(scene));
    notes.remark(scene.source, 0, "the file has no camera; one that frames everything is added");
    add_default_light(scene, notes);
}

void add_default_light(Scene& scene, NoteSink& notes) {
    if (has_light(scene)) {
        return;
    }
    const Aabb box = bounds(scene);
    scene.environment.width = 1;
    scene.environment.height = 1;
    scene.environment.radiance = {{1, 1, 1}};
    const float radius = radius_of(box);
    Emitter key{};
    key.type = NEARLIGHT_EMITTER_POINT;
    key.position = box.center() + radius * Vec3{1.5f, 2.5f, 1.0f};
    // The irradiance is about 4 at the middle of the box, whatever its size.
    const float intensity = 4.0f * radius * radius * dot({1.5f, 2.5f, 1.0f}, {1.5f, 2.5f, 1.0f});
    key.radiance = {intensity, intensity, intensity};
    scene.delta_emitters.push_back(key);
    notes.remark(scene.source, 0, "nothing emits light; an even sky and a point light are added");
}

}  // namespace nearlight::core
