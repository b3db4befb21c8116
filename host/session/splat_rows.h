// SPDX-License-Identifier: Apache-2.0
// Turns the splats of a picture's rows into its layers of light.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "host/scene/scene.h"
#include "kernels/shared/splats.h"
#include "nearlight/settings.h"

namespace nearlight::core {

/// With fewer samples a pixel, the sums of their weights differ too much from pixel to pixel.
inline constexpr uint kMinSplattedSamples = 4;

/// Camera::splat_reach for pictures with a filter: 0 if samples count in their own pixel alone. That is so
/// for filters that reach no other pixel or reach too far, and where the settings ask for it or have few
/// samples.
uint splat_reach(const PixelFilter& filter, const GatherSettings& settings);

/// The floats that a device delivers for each pixel of a band: the layers, and after those of all pixels
/// splat_rows() RowSplats for each, if `reach` is above 0.
std::size_t band_floats_per_pixel(uint reach);

/// Takes the bands of one picture from top to bottom, and returns rows of layers as soon as all rows came
/// that have splats for them. A pixel's light is the sum of the samples that reach it, ÷ that of their
/// weights.
class SplatRows {
  public:
    /// With a reach of 0, rows pass unchanged.
    SplatRows(uint width, uint reach, uint samples_per_pixel)
        : width_(width), reach_(reach), samples_(samples_per_pixel) {}

    /// Takes a band, and replaces it by the rows that are finished now.
    void take(std::vector<float>& band);
    /// Returns the rows that waited for rows below the picture.
    std::vector<float> finish();

  private:
    [[nodiscard]] std::size_t row_count() const;
    void finish_row(std::size_t row, std::vector<float>& finished);
    void drop_rows();

    uint width_;
    uint reach_;
    uint samples_;
    std::size_t first_ = 0;  ///< the topmost row that is kept
    std::size_t next_ = 0;   ///< the topmost row that is not finished
    std::vector<float> layers_;
    std::vector<RowSplat> splats_;
};

}  // namespace nearlight::core
