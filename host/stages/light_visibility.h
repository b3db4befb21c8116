// SPDX-License-Identifier: Apache-2.0
// Which triangles the light can reach.
#pragma once

#include "host/cl/kernel.h"
#include "host/stages/device_scene.h"

namespace nearlight::core {

class LightVisibility {
  public:
    explicit LightVisibility(Device& device);

    /// Sets selected[id] = 1 for each of the first `id_count` triangle ids where some light reaches a test
    /// point. All other elements stay as they are.
    void run(const DeviceScene& scene, const Buffer<uint>& ids, std::size_t id_count, uint seed,
             Buffer<uint>& selected);

  private:
    Program program_;
    Kernel light_visibility_;
};

}  // namespace nearlight::core
