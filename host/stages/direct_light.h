// SPDX-License-Identifier: Apache-2.0
// The irradiance that receivers get straight from the lights.
#pragma once

#include "host/cl/kernel.h"
#include "host/stages/device_scene.h"

namespace nearlight::core {

class DirectLight {
  public:
    explicit DirectLight(Device& device);

    /// Writes the direct light of each receiver to `irradiance`, in W/m². `sample_count`, at least 1, is the
    /// number of samples per receiver for area and environment lights; point and spot lights need no samples.
    void run(const DeviceScene& scene, const Buffer<ReceiverPacket>& receivers, std::size_t packet_count,
             uint sample_count, uint seed, Buffer<IrradiancePacket>& irradiance);

  private:
    Program program_;
    Kernel direct_light_;
};

}  // namespace nearlight::core
