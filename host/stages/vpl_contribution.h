// SPDX-License-Identifier: Apache-2.0
// How much each VPL brings to the camera, over a sample of receivers.
#pragma once

#include "host/cl/kernel.h"
#include "host/stages/device_scene.h"

namespace nearlight {

class VplContribution {
  public:
    explicit VplContribution(Device& device);

    /// One luminance for each of the first `vpl_count` VPLs, summed over all receivers of `packet_count` packets.
    void run(const DeviceScene& scene, const Buffer<Vpl>& vpls, uint vpl_count, const Buffer<ReceiverPacket>& receivers,
             const Buffer<CameraVertex>& vertices, uint packet_count, float clamp_radius, Buffer<float>& contribution);

  private:
    Program program_;
    Kernel vpl_contribution_;
};

}  // namespace nearlight
