// SPDX-License-Identifier: Apache-2.0
// Which triangle each camera sample sees first.
#pragma once

#include "host/cl/kernel.h"
#include "host/stages/device_scene.h"

namespace nearlight::core {

/// The samples of one launch: some of those of each pixel of a window.
struct SampleBlock {
    uint first_column = 0;
    uint first_row = 0;
    uint width = 0;  ///< pixels
    uint row_count = 0;
    uint first_sample = 0;
    uint sample_count = 1;
    bool in_middle = false;  ///< samples go through the middles of their pixels

    [[nodiscard]] std::size_t size() const { return std::size_t{width} * row_count * sample_count; }
};

/// The samples of CameraPass, without their light.
class FirstSurfaces {
  public:
    explicit FirstSurfaces(Device& device);

    /// Writes block.size() indices of triangles, pixel by pixel; ~0 for a sample that meets nothing.
    void run(const DeviceScene& scene, const Buffer<Camera>& camera, const SampleBlock& block, uint seed,
             Buffer<uint>& triangles);

  private:
    Program program_;
    Kernel first_surfaces_;
};

}  // namespace nearlight::core
