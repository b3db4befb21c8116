// SPDX-License-Identifier: Apache-2.0
// Splats: samples that count in all pixels whose reconstruction filter reaches them. The kernels are in
// splats.cl.
#pragma once

#include "host/cl/kernel.h"
#include "host/stages/camera_pass.h"
#include "host/stages/film.h"
#include "kernels/shared/splats.h"

namespace nearlight::core {

/// The number of splats that each pixel keeps.
constexpr std::size_t splats_per_pixel(uint reach) {
    return std::size_t{splat_rows(reach)} * splat_rows(reach);
}

/// Pixels that a launch covers, row by row, and the number of the sample before which the first half of a
/// pixel's samples ends.
struct SplatPixels {
    uint width = 0;
    uint row_count = 0;
    uint half_end = 0;
};

/// `camera` holds one element, whose splat_reach is that of the pixels and above 0.
class Splats {
  public:
    explicit Splats(Device& device);

    /// Adds a batch of samples to `splats`, which holds splats_per_pixel() elements for each pixel. Leaves
    /// out the light that camera paths bring on their own unless `with_camera_light`.
    void add(const Buffer<CameraVertex>& vertices, const ReceivedIrradiance& irradiance,
             const Buffer<Camera>& camera, const CameraBatch& batch, const SplatPixels& pixels,
             bool with_camera_light, Buffer<Splat>& splats);
    /// Adds the light that the camera paths of a batch bring on their own to `splats`, which holds
    /// splats_per_pixel() elements for each pixel.
    void add_camera_light(const Buffer<CameraVertex>& vertices, const Buffer<Camera>& camera,
                          const CameraBatch& batch, const SplatPixels& pixels, Buffer<CameraSplat>& splats);
    /// Averages the camera light of `count` listed pixels with that of as many further paths as they have,
    /// which is in `added`. `scale` is the number of paths that pixels had at first ÷ that of `added`.
    void refine(const Buffer<uint>& listed, std::size_t first, std::size_t count, uint reach,
                const Buffer<CameraSplat>& added, float scale, Buffer<CameraSplat>& splats);
    /// Writes splat_rows() elements for each pixel: what its row brings to its column in the rows from
    /// `reach` above to `reach` below. `camera_splats` is null if `splats` have the camera light, too.
    void gather(const Buffer<Splat>& splats, const Buffer<CameraSplat>* camera_splats,
                const SplatPixels& pixels, uint reach, Buffer<RowSplat>& rows);

  private:
    Program program_;
    Kernel add_;
    Kernel add_camera_light_;
    Kernel refine_;
    Kernel gather_;
    Buffer<CameraSplat> none_;
};

}  // namespace nearlight::core
