// SPDX-License-Identifier: Apache-2.0
// Adds samples to pixels and turns the sums into the layers of the picture, on the device.
#pragma once

#include "host/cl/kernel.h"
#include "host/stages/camera_pass.h"
#include "host/stages/film_layers.h"

namespace nearlight::core {

/// The light of a batch's receivers.
struct ReceivedIrradiance {
    const Buffer<IrradiancePacket>& direct;    ///< straight from lights
    const Buffer<IrradiancePacket>& gathered;  ///< indirect, from VPLs
    const Buffer<IrradiancePacket>& indirect;  ///< indirect, by rays of the receivers
};

class Film {
  public:
    explicit Film(Device& device);

    /// Adds one batch of samples to `sums`, which holds NEARLIGHT_FILM_CHANNELS floats for each of width ×
    /// row_count pixels.
    void add(const Buffer<ReceiverPacket>& receivers, const Buffer<CameraVertex>& vertices,
             const ReceivedIrradiance& irradiance, const CameraBatch& batch, uint width, uint row_count,
             Buffer<float>& sums);
    /// Turns the sums of pixels into `layers`: NEARLIGHT_LAYER_CHANNELS floats per pixel, in the order of
    /// layer_channels().
    void resolve(const Buffer<float>& sums, std::size_t pixel_count, uint samples_per_pixel,
                 Buffer<float>& layers);

  private:
    Program program_;
    Kernel film_add_;
    Kernel film_resolve_;
};

}  // namespace nearlight::core
