// SPDX-License-Identifier: Apache-2.0
// The G-buffer: where camera paths meet their first diffuse surface.
#pragma once

#include "host/cl/kernel.h"
#include "host/stages/device_scene.h"

namespace nearlight::core {

/// Which tile rows and samples of the picture one launch covers.
struct CameraBand {
    uint first_tile_row = 0;
    uint tile_row_count = 0;  ///< the last row may reach below the picture
    uint first_sample = 0;
    uint sample_count = 1;
    uint samples_per_pixel = 1;  ///< over all batches; if it is 1, the sample goes through the pixel's centre
    uint branch_count = 1;       ///< 2 if camera paths may divide, else 1
    uint max_depth = 8;          ///< maximum number of edges of a path from the camera to a light
    /// Samples of area lights and the environment at each surface that reflects other than by a Lambertian
    /// part; at least 1.
    uint light_samples = 1;
    /// Receivers of less weight than this are absent, and rays of their own bring their light; 0: none are.
    float min_weight = 0.0f;
};

/// The number of receiver packets in a band: tiles × samples × branches.
std::size_t packet_count(const CameraBand& band, uint image_width);

class CameraPass {
  public:
    explicit CameraPass(Device& device);

    /// Writes packet_count() packets and 64 vertices for each of them, in the order that
    /// kernels/camera_pass.cl states.
    void run(const DeviceScene& scene, const Buffer<Camera>& camera, uint image_width,
             const Buffer<CloseRange>& close_range, const CameraBand& band, uint seed,
             Buffer<ReceiverPacket>& receivers, Buffer<CameraVertex>& vertices);

  private:
    Program program_;
    Kernel camera_pass_;
};

}  // namespace nearlight::core
