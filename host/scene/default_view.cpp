// SPDX-License-Identifier: Apache-2.0
#include "host/scene/default_view.h"

#include <algorithm>
#include <cmath>

namespace nearlight::core {
namespace {

constexpr double kFieldOfView = 45.0;
constexpr float kFilled = 0.88f;  // share of the frame's width or height that the scene fills
// The direction from the middle of the box towards the camera.
constexpr Vec3 kTowardsCamera{0.45f, 0.4f, 0.8f};
constexpr Vec3 kTowardsLamp{-0.5f, 0.8f, 0.7f};
constexpr int kViewSkyWidth = 128;  // pixels

/// The radiance of the neutral sky: grey, dark below, where the camera sees it behind things, with a wide
/// lamp that shows their shapes.
Vec3 neutral_radiance(Vec3 direction) {
    const float height = std::clamp((direction.y + 0.25f) / 0.85f, 0.0f, 1.0f);
    const float even = 0.12f + 0.88f * height * height * (3.0f - 2.0f * height);
    const float lamp = 5.0f * std::exp(12.0f * (dot(direction, normalize(kTowardsLamp)) - 1.0f));
    return Vec3{1, 1, 1} * (even + lamp);
}

EnvironmentLight neutral_sky() {
    EnvironmentLight sky;
    sky.width = kViewSkyWidth;
    sky.height = kViewSkyWidth / 2;
    sky.is_interpolated = true;
    for (int row = 0; row < sky.height; ++row) {
        const float theta = kPi * static_cast<float>(row) / static_cast<float>(sky.height - 1);
        for (int column = 0; column < sky.width; ++column) {
            const float phi =
                2.0f * kPi * (static_cast<float>(column) + 0.5f) / static_cast<float>(sky.width);
            sky.radiance.push_back(neutral_radiance(
                {std::sin(phi) * std::sin(theta), std::cos(theta), -std::cos(phi) * std::sin(theta)}));
        }
    }
    return sky;
}

/// What must be seen on both sides of the frame's middle, in one direction: points at the right and left, or
/// above and below. The camera must stand at the distance reach() from the target, moved by shift().
struct Fit {
    float positive_side = -INFINITY;
    float negative_side = -INFINITY;

    /// A point `across` to one side and `along` behind the target; the frame's slope is that of its side.
    void add(float across, float along, float slope) {
        positive_side = std::max(positive_side, across / slope - along);
        negative_side = std::max(negative_side, -across / slope - along);
    }
    [[nodiscard]] float reach() const { return 0.5f * (positive_side + negative_side); }
    [[nodiscard]] float shift(float slope) const { return 0.5f * slope * (positive_side - negative_side); }
};

}  // namespace

SceneCamera default_camera(const Scene& scene) {
    SceneCamera camera;
    camera.fov_x_degrees = kFieldOfView;
    camera.filter = default_filter(kUsualFilter);
    const Aabb box = bounds(scene);
    const Vec3 away = normalize(kTowardsCamera);
    const Vec3 right = normalize(cross({0, 1, 0}, away));
    const Vec3 up = cross(away, right);
    const float slope_x = kFilled * std::tan(degrees_to_radians(static_cast<float>(kFieldOfView) / 2));
    const float slope_y = slope_x * static_cast<float>(camera.height) / static_cast<float>(camera.width);
    Fit across;
    Fit upwards;
    for (const Triangle& triangle : scene.triangles) {
        for (const uint vertex : {triangle.v0, triangle.v1, triangle.v2}) {
            const Vec3 p = scene.vertices[vertex].position - box.center();
            across.add(dot(p, right), -dot(p, away), slope_x);
            upwards.add(dot(p, up), -dot(p, away), slope_y);
        }
    }
    const float smallest = std::max(1e-3f, 1e-3f * length(box.size()));
    const float distance =
        scene.triangles.empty() ? 1.0f : std::max({across.reach(), upwards.reach(), smallest});
    const Vec3 aside =
        scene.triangles.empty() ? Vec3{0, 0, 0} : across.shift(slope_x) * right + upwards.shift(slope_y) * up;
    const Vec3 target = box.center() + aside;
    const Vec3 origin = target + away * distance;
    camera.to_world = look_at({origin.x, origin.y, origin.z}, {target.x, target.y, target.z}, {0, 1, 0});
    return camera;
}

void add_default_camera(Scene& scene, bool is_placed, NoteSink& notes) {
    scene.camera = default_camera(scene);
    if (!is_placed) {
        notes.remark(scene.source, 0, "the file has no camera; one that frames everything is added");
    }
}

void add_default_light(Scene& scene, bool surfaces_are_lamps, NoteSink& notes) {
    if (!has_light(scene, surfaces_are_lamps)) {
        scene.environment = neutral_sky();
        notes.remark(scene.source, 0,
                     has_emitting_surface(scene)
                         ? "the file has no light but surfaces that glow, and no camera; a "
                           "neutral sky is added"
                         : "the file has no light; a neutral sky is added");
    }
}

}  // namespace nearlight::core
