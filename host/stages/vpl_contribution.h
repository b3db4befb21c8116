// SPDX-License-Identifier: Apache-2.0
// How much each VPL brings to the camera, over a sample of receivers.
#pragma once

#include "host/cl/kernel.h"
#include "host/stages/device_scene.h"
#include "host/stages/gatherer.h"
#include "host/stages/pilot_view.h"

namespace nearlight {

class VplContribution {
  public:
    /// Gathers with `gatherer`, which must outlive it.
    VplContribution(Device& device, Gatherer& gatherer);

    /// VPLs as receivers, receiver_packet_count(vpl_count) packets.
    void make_receivers(const Buffer<Vpl>& vpls, std::size_t vpl_count, Buffer<ReceiverPacket>& receivers);

    /// One luminance for each of the first `vpl_count` VPLs, summed over all importons of the view.
    void run(const DeviceScene& scene, const Buffer<Vpl>& vpls, std::size_t vpl_count, const PilotView& view,
             float clamp_radius, Buffer<float>& contribution);

  private:
    Device* device_;
    Gatherer* gatherer_;
    Program program_;
    Kernel vpl_receivers_;
    Kernel vpl_contribution_;
};

/// Packets that hold so many receivers.
inline std::size_t receiver_packet_count(std::size_t receiver_count) {
    return (receiver_count + NEARLIGHT_PACKET_SIZE - 1) / NEARLIGHT_PACKET_SIZE;
}

}  // namespace nearlight
