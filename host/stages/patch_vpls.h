// SPDX-License-Identifier: Apache-2.0
// Makes close-range VPLs of points that were placed on surfaces.
#pragma once

#include "host/cl/kernel.h"
#include "host/stages/device_scene.h"
#include "host/stages/light_tracer.h"

namespace nearlight::core {

class PatchVpls {
  public:
    explicit PatchVpls(Device& device);

    /// Writes the two sides of each sample as VPLs to 2 · sample_count slots: front, back, front, …. The flag
    /// of a slot is 1 if the slot holds a VPL, else 0. The power is albedo · area_per_sample (m²) and still
    /// has to be multiplied by the irradiance.
    void run(const DeviceScene& scene, const Buffer<SurfaceSample>& samples, std::size_t sample_count,
             const CloseRegion& region, float area_per_sample, Buffer<Vpl>& vpls, Buffer<uint>& flags);

  private:
    Program program_;
    Kernel patch_vpls_;
};

}  // namespace nearlight::core
