// SPDX-License-Identifier: Apache-2.0
// The light that camera paths bring on their own, for the pixels of a band, and the pixels that need more of
// these paths. The kernels are in camera_lights.cl.
#pragma once

#include "host/cl/kernel.h"
#include "host/stages/camera_pass.h"

namespace nearlight::core {

/// The pixels of a band and the samples that all of them have.
struct CameraLightBand {
    uint width = 0;      ///< pixels
    uint row_count = 0;  ///< pixels; the first row is the first one of a tile
    uint sample_count = 0;
};

class CameraLights {
  public:
    explicit CameraLights(Device& device);

    /// Adds the light of a batch to `lights`, which holds one element for each of width × row_count pixels.
    /// The first half of the samples ends before number `half_end`.
    void add(const Buffer<CameraVertex>& vertices, const CameraBatch& batch, uint width, uint row_count,
             uint half_end, Buffer<CameraLight>& lights);
    /// Writes how many rounds each pixel gets, 0 to 3, after all samples of the band. `sums` are those of the
    /// film. There must be at least two samples.
    void choose(const Buffer<CameraLight>& lights, const Buffer<float>& sums, const CameraLightBand& band,
                Buffer<uint>& rounds);
    /// Adds what further samples of `count` listed pixels brought to `lights` and to the sums of the film,
    /// and takes 1 from their rounds. `scale` is the samples of a pixel at first ÷ those it has now.
    void refine(const Buffer<uint>& pixels, std::size_t first, std::size_t count,
                const Buffer<CameraLight>& added, float scale, Buffer<CameraLight>& lights,
                Buffer<float>& sums, Buffer<uint>& rounds);

  private:
    Program program_;
    Kernel add_;
    Kernel rounds_;
    Kernel refine_;
};

}  // namespace nearlight::core
