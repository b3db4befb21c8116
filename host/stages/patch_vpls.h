// SPDX-License-Identifier: Apache-2.0
// Close-range VPLs from samples placed on surfaces.
#pragma once

#include "host/cl/kernel.h"
#include "host/stages/device_scene.h"
#include "host/stages/light_tracer.h"

namespace nearlight {

/// Packets that hold both sides of `sample_count` samples.
inline std::size_t patch_packet_count(std::size_t sample_count) {
    return (sample_count + NEARLIGHT_PACKET_SIZE - 1) / NEARLIGHT_PACKET_SIZE * 2;
}

class PatchVpls {
  public:
    explicit PatchVpls(Device& device);

    /// Both sides of each sample as receivers, patch_packet_count() packets.
    void make_receivers(const DeviceScene& scene, const Buffer<SurfaceSample>& samples, uint sample_count,
                        const CloseRegion& region, Buffer<ReceiverPacket>& receivers);
    /// VPLs of power albedo · irradiance · area_per_sample in 64 slots a packet; flags tell which slots hold one.
    void make_vpls(const DeviceScene& scene, const Buffer<SurfaceSample>& samples, uint sample_count,
                   const Buffer<ReceiverPacket>& receivers, const Buffer<IrradiancePacket>& irradiance,
                   float area_per_sample, Buffer<Vpl>& vpls, Buffer<uint>& flags);

  private:
    Program program_;
    Kernel patch_receivers_;
    Kernel patch_vpls_;
};

}  // namespace nearlight
