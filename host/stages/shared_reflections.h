// SPDX-License-Identifier: Apache-2.0
// Light that surfaces reflect other than diffusely, which the rays of single receivers find and which all
// receivers of their bundle share. The kernel is in shared_reflections.cl.
#pragma once

#include "host/stages/shared_light_lists.h"

namespace nearlight::core {

class SharedReflections {
  public:
    /// Begins to compile the kernel.
    explicit SharedReflections(Device& device);

    /// Adds to the irradiance (W/m²) of each receiver that shares lights what ReceiverPaths::run_sharing()
    /// left to the reflections of `found`, with settings.shares_reflections: unbiased estimates. The tree of
    /// the scene must be uploaded for the kernel of `lists`, which are made anew.
    void add(const ReceiverBatch& batch, SharedLightLists& lists, const FoundLights& found,
             Buffer<IrradiancePacket>& irradiance);

  private:
    Program program_;
    Kernel gather_;
};

}  // namespace nearlight::core
