// SPDX-License-Identifier: Apache-2.0
// What the camera sees in a picture of few pixels, for choices that are made before the picture.
#pragma once

#include "host/scene/scene.h"
#include "host/stages/camera_pass.h"

namespace nearlight::core {

struct SmallView {
    Vec3 origin{};  ///< of the camera
    std::size_t packet_count = 0;
    Buffer<ReceiverPacket> receivers;
    Buffer<CameraVertex> vertices;  ///< one a receiver
};

/// Looks at the scene with a picture of so many pixels, whose sides are at least 1. The batch says how many
/// samples a pixel has, and how camera paths go; it gets all tiles of the picture.
SmallView look_at_few_pixels(Device& device, CameraPass& camera_pass, const DeviceScene& scene,
                             const SceneCamera& camera, int width, int height, CameraBatch batch, uint seed);

}  // namespace nearlight::core
