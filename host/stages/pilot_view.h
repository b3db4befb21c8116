// SPDX-License-Identifier: Apache-2.0
// A small picture's worth of receivers, by which settings are chosen that nobody gave.
#pragma once

#include <span>
#include <vector>

#include "host/scene/scene.h"
#include "host/stages/camera_pass.h"

namespace nearlight {

struct PilotView {
    Buffer<ReceiverPacket> receivers;
    Buffer<CameraVertex> vertices;
    uint packet_count = 0;
    /// The receivers as senders of importance: power is the response of the camera to what they reflect (the
    /// albedo times the weight of the camera path), so that a gather from them tells what a VPL would bring
    /// to the camera.
    Buffer<Vpl> importons;
    /// Some of them, with squared responses and marked for squared geometry terms.
    Buffer<Vpl> squared_importons;
    std::size_t squared_importon_count = 0;
    std::size_t importon_count = 0;
    std::vector<float> distances;  ///< of the receivers from the camera, ascending, m; empty: nothing in view
};

/// What the camera sees of light, one importon for each receiver that reflects any of it.
std::vector<Vpl> make_importons(const std::vector<ReceiverPacket>& packets,
                                const std::vector<CameraVertex>& vertices);

/// Uploads them, and their squares.
void set_importons(Device& device, PilotView& view, std::span<const Vpl> importons);

/// About a thousand receivers, evenly spread over the view.
PilotView look_at_scene(Device& device, CameraPass& camera_pass, const DeviceScene& scene,
                        const SceneCamera& camera, uint seed);

}  // namespace nearlight
