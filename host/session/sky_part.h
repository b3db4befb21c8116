// SPDX-License-Identifier: Apache-2.0
// How much of what the camera sees lies under the open sky, by a pilot.
#pragma once

#include "host/stages/pilot_view.h"
#include "host/stages/receiver_paths.h"

namespace nearlight::core {

/// Above this part, bundles leave most of what their rays find of the sky unused, and sharing it makes tiles
/// of noise (bench/log/sharing.md).
inline constexpr float kMaxSharedSkyPart = 1.0f / 16;

/// The part of the cosine-distributed rays of the view's receivers that meet the sky, 0 without a sky.
/// Receivers whose normal a map tilts do not count, because they share nothing. The view must be on the
/// device of `paths`.
float sky_part(Device& device, ReceiverPaths& paths, const DeviceScene& scene, const PilotView& view,
               uint seed);

}  // namespace nearlight::core
