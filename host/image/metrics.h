// SPDX-License-Identifier: Apache-2.0
// Measures of the difference between two pictures, layer by layer.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "host/image/image.h"

namespace nearlight::core {

/// All figures are NaN if no pixel is finite in both pictures.
struct ImageDifference {
    double rmse = 0;             ///< root mean square over pixels and channels (the paper's measure)
    double relative_mse = 0;     ///< mean of (a − b)² / (b² + 0.01), b the reference
    double mean_ratio = 0;       ///< mean luminance of a ÷ that of b: light lost or gained; NaN for vectors
    double flip = 0;             ///< mean FLIP of the pictures on a screen [Andersson et al. 2020]; NaN for
                                 ///< what is not a colour
    std::size_t non_finite = 0;  ///< pixels with NaN or infinity in either picture; not in the figures
};

/// The names of the layers that have channels R, G and B, in the order of the file; "" stands for R, G and B
/// without a name.
std::vector<std::string> color_layers(const Image& image);
bool has_color_layer(const Image& image, const std::string& layer);

/// Compares a layer of a with that of the reference b: the three channels `layer`.R, .G, .B (or R, G, B for
/// an empty layer), or else the one to three channels that the file has under this name, such as depth.Z or
/// N.X, N.Y and N.Z. For FLIP, a screen shows `scale` times the values, and as white what is above 1. Throws
/// Error(ErrorKind::file) if the sizes differ or a channel is missing.
ImageDifference compare_images(const Image& a, const Image& b, const std::string& layer = "",
                               float scale = 1);
/// The FLIP error of each pixel of a layer, as channels R, G, B in a magma-like colour map. Throws as
/// compare_images() does, and for layers that are not colours.
Image flip_map(const Image& a, const Image& b, const std::string& layer = "", float scale = 1);

}  // namespace nearlight::core
