// SPDX-License-Identifier: Apache-2.0
#include "host/stages/patch_vpls.h"

namespace nearlight {

PatchVpls::PatchVpls(Device& device)
    : program_(device, "patch_vpls.cl"),
      patch_receivers_(program_, "patch_receivers"),
      patch_vpls_(program_, "patch_vpls") {}

void PatchVpls::make_receivers(const DeviceScene& scene, const Buffer<SurfaceSample>& samples, uint sample_count,
                               const CloseRegion& region, Buffer<ReceiverPacket>& receivers) {
    const std::size_t lane_count = patch_packet_count(sample_count) * NEARLIGHT_PACKET_SIZE;
    patch_receivers_.launch_items(lane_count, scene, samples, sample_count, region.range,
                                  region.whole_triangles ? 1u : 0u, static_cast<uint>(lane_count), receivers);
}

void PatchVpls::make_vpls(const DeviceScene& scene, const Buffer<SurfaceSample>& samples, uint sample_count,
                          const Buffer<ReceiverPacket>& receivers, const Buffer<IrradiancePacket>& irradiance,
                          float area_per_sample, Buffer<Vpl>& vpls, Buffer<uint>& flags) {
    const std::size_t lane_count = patch_packet_count(sample_count) * NEARLIGHT_PACKET_SIZE;
    patch_vpls_.launch_items(lane_count, scene, samples, sample_count, receivers, irradiance, area_per_sample,
                             static_cast<uint>(lane_count), vpls, flags);
}

}  // namespace nearlight
