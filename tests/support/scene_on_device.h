// SPDX-License-Identifier: Apache-2.0
// A scene in both host and device memory, and receivers at given points.
#pragma once

#include <utility>
#include <vector>

#include "host/base/receivers.h"
#include "host/stages/device_scene.h"

namespace nearlight::core::test {

struct SceneOnDevice {
    SceneOnDevice(Device& device, Scene a_scene)
        : scene(std::move(a_scene)), bvh(build_scene_bvh(scene)), buffers(upload_scene(device, scene, bvh)) {}

    Scene scene;
    Bvh bvh;
    DeviceScene buffers;
};

/// Packets that hold the points in order. The other lanes of the last packet are absent.
inline std::vector<ReceiverPacket> pack_receivers(const std::vector<ReceiverPoint>& points) {
    std::vector<ReceiverPacket> packets(receiver_packet_count(points.size()));
    for (std::size_t i = 0; i < points.size(); ++i) {
        set_receiver(packets[i / NEARLIGHT_PACKET_SIZE], i % NEARLIGHT_PACKET_SIZE, points[i]);
    }
    return packets;
}

}  // namespace nearlight::core::test
