// SPDX-License-Identifier: Apache-2.0
// A small picture's worth of receivers, by which settings are chosen that nobody gave.
#pragma once

#include <vector>

#include "host/scene/scene.h"
#include "host/stages/camera_pass.h"

namespace nearlight {

struct PilotView {
    Buffer<ReceiverPacket> receivers;
    Buffer<CameraVertex> vertices;
    uint packet_count = 0;
    std::vector<float> distances;  ///< of the receivers from the camera, ascending, m; empty: nothing in view
};

/// About a thousand receivers, evenly spread over the view.
PilotView look_at_scene(Device& device, CameraPass& camera_pass, const DeviceScene& scene, const SceneCamera& camera,
                        uint seed);

}  // namespace nearlight
