// SPDX-License-Identifier: Apache-2.0
// Lights that the rays of single receivers find near by and that light all receivers of their bundle. The
// kernels are in shared_lights.cl.
#pragma once

#include "host/stages/shared_light_lists.h"

namespace nearlight::core {

class SharedLights {
  public:
    /// Begins to compile the kernel.
    explicit SharedLights(Device& device);

    /// Adds to the irradiance (W/m²) of each receiver that shares lights what those of its bundle bring: an
    /// unbiased estimate of what ReceiverPaths::run_sharing() left to found.near with the same settings. The
    /// tree of the scene must be uploaded for the kernel of `lists`, which are made anew.
    void add(const ReceiverBatch& batch, SharedLightLists& lists, const Buffer<SharedLight>& found,
             Buffer<IrradiancePacket>& irradiance);

  private:
    Program program_;
    Kernel gather_;
    Buffer<float> no_curves_;
};

}  // namespace nearlight::core
