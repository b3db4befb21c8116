// SPDX-License-Identifier: Apache-2.0
// Light walks from launch to download, for tests.
#pragma once

#include <cstring>
#include <vector>

#include "host/stages/light_tracer.h"
#include "tests/support/scene_on_device.h"

namespace nearlight::core::test {

/// No close range, or the close range of a camera with every triangle selected.
inline CloseRegion make_region(Device& device, const DeviceScene& scene, const CloseRange& range,
                               uint selected) {
    CloseRegion region;
    region.range = Buffer<CloseRange>(device, std::span(&range, 1));
    region.triangles = Buffer<uint>(device, std::vector<uint>(scene.host_info.triangle_count, selected));
    return region;
}

inline std::vector<Vpl> trace_all(Device& device, const Scene& scene, const LightWalks& walks) {
    const SceneOnDevice on_device(device, scene);
    return LightTracer(device).run(on_device.buffers, make_region(device, on_device.buffers, {}, 0),
                                   KeepDeposits::all, walks);
}

/// Walks aim at a sphere alone.
inline WalkAim aim_at(Vec3 center, float radius) {
    WalkAim aim{};
    aim.center = center;
    aim.radius = radius;
    return aim;
}

/// Power of the deposits of each depth, W; entry 0 is depth 1.
struct Power {
    double x = 0, y = 0, z = 0;
};
inline std::vector<Power> power_by_depth(const std::vector<Vpl>& vpls, uint depths) {
    std::vector<Power> power(depths);
    for (const Vpl& vpl : vpls) {
        Power& sum = power.at(vpl.depth - 1);
        sum.x += vpl.power.x;
        sum.y += vpl.power.y;
        sum.z += vpl.power.z;
    }
    return power;
}

/// Whether two deposits have the same place, depth and power, to the bit.
inline bool same_deposit(const Vpl& a, const Vpl& b) {
    return std::memcmp(&a.position, &b.position, sizeof(Vec3)) == 0 && a.depth == b.depth &&
           std::memcmp(&a.power, &b.power, sizeof(Vec3)) == 0;
}

}  // namespace nearlight::core::test
