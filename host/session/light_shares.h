// SPDX-License-Identifier: Apache-2.0
// What each VPL and each emitter brings to one point: for people who want to know where light comes from.
#pragma once

#include <span>
#include <vector>

#include "host/cl/device.h"
#include "host/scene/scene.h"
#include "host/stages/device_scene.h"
#include "nearlight/light_share.h"

namespace nearlight::core {

/// A point of a surface that is to be lit.
struct LitPoint {
    Vec3 position{0, 0, 0};
    Vec3 normal{0, 0, 1};       ///< unit vector
    float clamp_radius = 0.0f;  ///< of VPLs, m
    uint seed = 0;              ///< of the rays that sample area lights, the sun and the environment
};

/// One share for each VPL, in their order, and then one for each emitter, where area lights whose triangles
/// share vertices are one. Images of spots, projectors and emitting surfaces count by their mean, and
/// transmission curves are taken as 1. Area lights and the environment are sampled by some thousand rays.
std::vector<LightShare> light_shares(Device& device, const DeviceScene& on_device, const Scene& scene,
                                     std::span<const Vpl> vpls, const LitPoint& point);

}  // namespace nearlight::core
