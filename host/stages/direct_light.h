// SPDX-License-Identifier: Apache-2.0
// Irradiance of receivers from the lights themselves.
#pragma once

#include "host/cl/kernel.h"
#include "host/stages/device_scene.h"

namespace nearlight::core {

class DirectLight {
  public:
    explicit DirectLight(Device& device);

    /// `sample_count` samples a receiver for area and environment lights (at least 1); point and spot lights
    /// need none.
    void run(const DeviceScene& scene, const Buffer<ReceiverPacket>& receivers, std::size_t packet_count,
             uint sample_count, uint seed, Buffer<IrradiancePacket>& irradiance);

  private:
    Program program_;
    Kernel direct_light_;
};

}  // namespace nearlight::core
