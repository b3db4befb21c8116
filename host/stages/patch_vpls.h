// SPDX-License-Identifier: Apache-2.0
// Close-range VPLs from samples placed on surfaces.
#pragma once

#include "host/cl/kernel.h"
#include "host/stages/device_scene.h"
#include "host/stages/light_tracer.h"

namespace nearlight::core {

class PatchVpls {
  public:
    explicit PatchVpls(Device& device);

    /// Both sides of each sample as VPLs in 2 · sample_count slots: front, back, front, …; flags tell which
    /// slots hold one. Power is albedo · area_per_sample, to be multiplied by the irradiance.
    void run(const DeviceScene& scene, const Buffer<SurfaceSample>& samples, std::size_t sample_count,
             const CloseRegion& region, float area_per_sample, Buffer<Vpl>& vpls, Buffer<uint>& flags);

  private:
    Program program_;
    Kernel patch_vpls_;
};

}  // namespace nearlight::core
