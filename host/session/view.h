// SPDX-License-Identifier: Apache-2.0
// The view to be rendered, with every setting decided.
#pragma once

#include "host/scene/scene.h"
#include "host/stages/pilot_view.h"
#include "kernels/shared/walk_aim.h"
#include "nearlight/settings.h"

namespace nearlight::core {

struct View {
    SceneCamera scene_camera;  ///< at the size to render
    Camera camera{};
    CloseRange close_range{};
    std::vector<Opening> openings{};  ///< at which walks aim, at most NEARLIGHT_MAX_OPENINGS
    PilotView pilot;                  ///< in the memory of the device that led when the view was chosen
    float clamp_radius = 0.0f;        ///< R of the bounded geometry term, m
    /// Whether the settings left the clamp radius open. VPLs may then be gathered with a radius of their own
    /// (VplSet::ray_budget).
    bool clamp_radius_is_open = false;
    bool has_ray_budget_pilot = true;      ///< whether Session::sample() runs the pilot of ray_budget.h
    float sky_part = 0.0f;                 ///< what sky_part() of sky_part.h says of the pilot view
    uint max_depth = kUnlimitedPathDepth;  ///< maximum path length, as Mitsuba counts it
    uint seed = 0;                         ///< seed of the pilot view

    /// The maximum depth of a VPL.
    [[nodiscard]] uint bounce_count() const { return max_depth > 2 ? max_depth - 2 : 0; }
};

/// Decides what the settings leave open: it takes size and depth from camera and scene, sets the range so
/// that the close range holds nine tenths of what the camera sees, and sets the clamp radius to a twentieth
/// of the range. Leaves View::openings and View::sky_part to the caller.
View choose_view(Device& device, CameraPass& camera_pass, const DeviceScene& device_scene, const Scene& scene,
                 const SceneCamera& camera, const ViewSettings& settings, uint seed);

/// Warns, and returns true, if the scene is so much wider than what the view shows that shadow rays from its
/// far end pass by what the view shows: they leave out a part of their length at their ends.
bool warn_of_width(const DeviceScene& scene, const View& view);

}  // namespace nearlight::core
