// SPDX-License-Identifier: Apache-2.0
// Light of the sky that the rays of single receivers find and that all receivers of their bundle share. The
// kernel is in shared_sky.cl.
#pragma once

#include "host/stages/shared_light_lists.h"

namespace nearlight::core {

/// The surfaces that the camera sees at receivers, as CameraPass::run() wrote them: one for each receiver, or
/// none.
struct SeenSurfaces {
    const Buffer<SeenSurface>& surfaces;
    Buffer<CameraVertex>& vertices;
    uint rays = 1;  ///< that each of them sends in search of lights (CameraBatch::light_rays)
};

class SharedSky {
  public:
    /// Begins to compile the kernel.
    explicit SharedSky(Device& device);

    /// Adds to the irradiance (W/m²) of each receiver that shares lights what ReceiverPaths::run_sharing()
    /// left to found.sky, and to the vertices what the camera pass with the same rays left of the light that
    /// surfaces reflect other than diffusely: unbiased estimates. The tree of the scene must be uploaded for
    /// the kernel of `lists`, which are made anew.
    void add(const ReceiverBatch& batch, SharedLightLists& lists, const Buffer<SharedLight>& found,
             const SeenSurfaces& seen, Buffer<IrradiancePacket>& irradiance);

  private:
    Program program_;
    Kernel gather_;
};

}  // namespace nearlight::core
