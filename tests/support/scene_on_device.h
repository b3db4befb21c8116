// SPDX-License-Identifier: Apache-2.0
// A scene in host and device memory at once, and receivers made by hand.
#pragma once

#include <utility>
#include <vector>

#include "host/stages/device_scene.h"

namespace nearlight::test {

struct SceneOnDevice {
    SceneOnDevice(Device& device, Scene a_scene)
        : scene(std::move(a_scene)),
          bvhs(build_scene_bvhs(scene)),
          buffers(upload_scene(device, scene, bvhs)) {}

    Scene scene;
    SceneBvhs bvhs;
    DeviceScene buffers;
};

struct ReceiverPoint {
    Vec3 position;
    Vec3 normal;  ///< zero: absent
};

/// Packets that hold the points in order; what is left of the last one is absent.
inline std::vector<ReceiverPacket> pack_receivers(const std::vector<ReceiverPoint>& points) {
    std::vector<ReceiverPacket> packets((points.size() + NEARLIGHT_PACKET_SIZE - 1) / NEARLIGHT_PACKET_SIZE);
    for (std::size_t i = 0; i < points.size(); ++i) {
        ReceiverPacket& packet = packets[i / NEARLIGHT_PACKET_SIZE];
        const std::size_t lane = i % NEARLIGHT_PACKET_SIZE;
        packet.px[lane] = points[i].position.x;
        packet.py[lane] = points[i].position.y;
        packet.pz[lane] = points[i].position.z;
        packet.nx[lane] = points[i].normal.x;
        packet.ny[lane] = points[i].normal.y;
        packet.nz[lane] = points[i].normal.z;
    }
    return packets;
}
inline ReceiverPoint receiver_at(const std::vector<ReceiverPacket>& packets, std::size_t index) {
    const ReceiverPacket& packet = packets[index / NEARLIGHT_PACKET_SIZE];
    const std::size_t lane = index % NEARLIGHT_PACKET_SIZE;
    return {{packet.px[lane], packet.py[lane], packet.pz[lane]},
            {packet.nx[lane], packet.ny[lane], packet.nz[lane]}};
}
inline Vec3 irradiance_at(const std::vector<IrradiancePacket>& packets, std::size_t index) {
    const IrradiancePacket& packet = packets[index / NEARLIGHT_PACKET_SIZE];
    const std::size_t lane = index % NEARLIGHT_PACKET_SIZE;
    return {packet.r[lane], packet.g[lane], packet.b[lane]};
}

}  // namespace nearlight::test
