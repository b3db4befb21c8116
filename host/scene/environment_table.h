// SPDX-License-Identifier: Apache-2.0
// Tables for importance sampling of an environment, small enough for a processor's caches.
//
// The map is divided into blocks of pixels. A block is chosen in proportion to the luminance that it sends
// out, and then either a direction that is uniform over the block's solid angle, or, where that would add
// noise, a pixel of the block in proportion to its luminance.
#pragma once

#include <vector>

#include "host/scene/scene.h"

namespace nearlight::core {

struct EnvironmentTable {
    Environment parameters{};
    std::vector<float> pixels;       ///< RGBA radiance, 4·width·height; one zero pixel without a map
    std::vector<float> row_cosines;  ///< cos(π·i/height), i from 0 to height: where row i of pixels begins
    /// Cumulative distributions (distribution.h) of the rows of blocks, and of the blocks of each row.
    std::vector<float> row_cdf;     ///< block_rows
    std::vector<float> column_cdf;  ///< block_columns·block_rows
    /// For each block, where its distributions of pixels begin in detail_cdf, or NEARLIGHT_NO_DETAIL.
    std::vector<uint> block_details;
    /// For each block that has details, the distribution of its rows of pixels, and then those of the pixels
    /// of each row.
    std::vector<float> detail_cdf;
};

/// The tables of the scene's environment. Without a map they have one black pixel, which is not to be chosen.
EnvironmentTable build_environment_table(const Scene& scene);

/// The luminance of each pixel, row by row. Where radiance is interpolated, a pixel's neighbours reach into
/// it, so that it has a part of theirs: no direction that shines may have the density 0.
std::vector<float> pixel_weights(const EnvironmentLight& environment);

/// 1 − cosine of the half angle under which the sun is seen; 0 without a sun.
double sun_height(const EnvironmentLight& environment);

}  // namespace nearlight::core
