// SPDX-License-Identifier: Apache-2.0
#include "host/session/view.h"

#include <algorithm>

#include "host/base/message.h"
#include "host/base/short_text.h"
#include "host/scene/camera.h"
#include "host/stages/close_range.h"

namespace nearlight::core {
namespace {

constexpr float kClampRadiusToRange = 0.05f;

/// The distance within which nine tenths of the visible surface lie, plus a small margin; the scene's extent
/// if nothing is in view.
float automatic_range(const PilotView& pilot, float extent) {
    if (pilot.distances.empty()) {
        say_warning("the camera sees no diffuse surface; is it inside an object, or looking away?");
        return std::max(extent, 1e-6f);
    }
    const std::size_t index = (pilot.distances.size() - 1) * 9 / 10;
    return std::max(pilot.distances[index] * 1.05f, 1e-6f);
}

}  // namespace

View choose_view(Device& device, CameraPass& camera_pass, const DeviceScene& device_scene, const Scene& scene,
                 const SceneCamera& camera, const ViewSettings& settings, uint seed) {
    View view;
    view.seed = seed;
    view.scene_camera = settings.camera ? posed(camera, *settings.camera) : camera;
    view.scene_camera.width = settings.width.value_or(camera.width);
    view.scene_camera.height = settings.height.value_or(camera.height);
    view.camera = make_camera(view.scene_camera, view.scene_camera.width, view.scene_camera.height);
    view.max_depth = settings.max_depth.value_or(static_cast<uint>(scene.max_depth));
    view.pilot = look_at_scene(device, camera_pass, device_scene, view.scene_camera, seed);
    const float range =
        settings.range ? *settings.range : automatic_range(view.pilot, device_scene.host_info.extent);
    view.close_range = make_close_range(view.camera, range);
    view.clamp_radius_is_open = !settings.clamp_radius;
    view.has_ray_budget_pilot = settings.ray_budget_pilot;
    view.clamp_radius = settings.clamp_radius.value_or(kClampRadiusToRange * range);
    say_debug("range " + std::to_string(range) + ", clamp radius " + std::to_string(view.clamp_radius) +
              ", max depth " + std::to_string(view.max_depth));
    return view;
}

bool warn_of_width(const DeviceScene& scene, const View& view) {
    constexpr float kMaxPartOfRange = 1.0f / 200;
    const float extent = scene.host_info.extent;
    const float offset = NEARLIGHT_SEGMENT_T_MIN * extent;
    if (offset <= kMaxPartOfRange * view.close_range.range) {
        return false;
    }
    say_warning("the scene is " + short_text(extent) +
                " m wide, so that light from its far parts passes by what is closer than about " +
                short_text(offset) +
                " m to a surface; leave out what lies far away, such as the rim of a large ground");
    return true;
}

}  // namespace nearlight::core
