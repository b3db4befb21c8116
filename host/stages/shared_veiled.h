// SPDX-License-Identifier: Apache-2.0
// Light of places behind veils, which the rays of single receivers find and which all receivers of their
// bundle share. The kernel is in shared_veiled.cl.
#pragma once

#include "host/stages/shared_light_lists.h"

namespace nearlight::core {

class SharedVeiled {
  public:
    /// Begins to compile the kernels. `kernel` is that of the gather.
    SharedVeiled(Device& device, GatherKernel kernel);

    /// Adds to the irradiance (W/m²) of each receiver that shares lights what ReceiverPaths::run_sharing()
    /// left to found.veiled, with settings.shares_veiled: unbiased estimates. The tree of the scene must be
    /// uploaded for the gather kernel.
    void add(const ReceiverBatch& batch, const Buffer<SharedLight>& found,
             Buffer<IrradiancePacket>& irradiance);

  private:
    SharedLightLists lists_;
    Program program_;
    Kernel gather_;
};

}  // namespace nearlight::core
