// SPDX-License-Identifier: Apache-2.0
// Openings, such as windows, through which light from outside comes to what the camera sees.
//
// Paths from what the camera sees that leave its surroundings are lines along which light comes in. Where
// they pass close to one another there is an opening, and walks that aim at it (kernels/lib/walk_aim.cl) come
// to what the camera sees a hundred times as often as those that aim at the whole house. An opening that is
// not found, or that is found in the wrong place, costs noise, not truth.
#pragma once

#include "host/stages/device_scene.h"
#include "host/stages/pilot_view.h"
#include "kernels/shared/walk_aim.h"

namespace nearlight::core {

/// Returns up to NEARLIGHT_MAX_OPENINGS openings of the surroundings, which are the sphere about the camera
/// whose radius is the range. There are none if no light comes from infinitely far away, or if the camera
/// looks at open country. The view must be on `device`.
std::vector<Opening> find_openings(Device& device, const DeviceScene& on_device, const Scene& scene,
                                   const PilotView& view, const CloseRange& close_range, uint seed);

}  // namespace nearlight::core
