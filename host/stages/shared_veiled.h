// SPDX-License-Identifier: Apache-2.0
// Light of places behind veils, which the rays of single receivers find and which all receivers of their
// bundle share. The kernel is in shared_veiled.cl.
#pragma once

#include "host/stages/shared_light_lists.h"

namespace nearlight::core {

class SharedVeiled {
  public:
    /// Begins to compile the kernel.
    explicit SharedVeiled(Device& device);

    /// Adds to the irradiance (W/m²) of each receiver that shares lights what ReceiverPaths::run_sharing()
    /// left to found.veiled, with settings.shares_veiled: unbiased estimates. The tree of the scene must be
    /// uploaded for the kernel of `lists`, which are made anew.
    void add(const ReceiverBatch& batch, SharedLightLists& lists, const Buffer<SharedLight>& found,
             Buffer<IrradiancePacket>& irradiance);

  private:
    Program program_;
    Kernel gather_;
};

}  // namespace nearlight::core
