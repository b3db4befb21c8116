// SPDX-License-Identifier: Apache-2.0
// Whether it pays that receivers aim at mirrors and glass, by a pilot.
#pragma once

#include "host/stages/pilot_view.h"
#include "host/stages/receiver_paths.h"

namespace nearlight::core {

/// Whether receivers of the view find light with less noise for the time if one more of their rays aims at
/// mirrors and glass. Paths have at most `max_edges` edges. False where the scene has no caustic aims. The
/// view must be on the device of `paths`.
bool caustic_aims_pay(Device& device, ReceiverPaths& paths, const DeviceScene& scene, const PilotView& view,
                      uint max_edges, uint seed);

}  // namespace nearlight::core
